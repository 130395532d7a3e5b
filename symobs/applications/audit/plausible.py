"""Whether a change that makes a printed equation true says what was meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.applications.audit.equations.evaluation import value_of
from symobs.applications.audit.equations.matrix_functions import Misfit, Unknown
from symobs.applications.audit.equations.sizes import Flexible, equal
from symobs.formula.expression.syntax_tree import every
from symobs.proof.certificate.claims import EVALUATION_ERRORS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.audit.equations.reading import Reading
    from symobs.exact import Matrix
    from symobs.formula.expression.syntax_tree import SyntaxNode


def is_plausible(printed: Sequence[SyntaxNode], changed: Sequence[SyntaxNode], reading: Reading) -> bool:
    """Return whether an equation may have been meant as it was changed: by what is in it, not by what is lost.

    A term that vanishes, L (y - C x) for L (y - C x_hat), leaves its factor L free; and a letter that is given by
    signals, u = -K x, was not given by their derivatives, which hold whatever it is.
    """
    if printed[0].kind == "letter" and not _derivatives(printed, reading) and _derivatives(changed, reading):
        return False
    known = {part for side in printed for part in every(side)}
    new = [part for side in changed if not _vanishes(side, reading) for part in every(side) if part not in known]
    return not any(part.kind in {"sum", "product", "negative"} and _vanishes(part, reading) for part in new)


def _derivatives(sides: Sequence[SyntaxNode], reading: Reading) -> bool:
    """Return whether there is a derivative of a signal in an equation."""
    signals = reading.environment.signals
    return any(
        part.kind == "primed" and part.parts[0].text in signals and part.parts[0].kind == "letter"
        for side in sides
        for part in every(side)
    )


def _vanishes(node: SyntaxNode, reading: Reading) -> bool:
    """Return whether a part of an equation is zero."""
    try:
        found = value_of(node, reading)
        return found.factor.is_zero if isinstance(found, Flexible) else equal(found, found - found)
    except (Misfit, Unknown, *EVALUATION_ERRORS):
        return False


def is_evident(left: SyntaxNode, exact: Matrix, printed: Matrix, wrong: int) -> bool:
    """Return whether the error lies in numbers on the right: a value of a letter, an entry, a number.

    A single number says too little to tell which letter was meant instead of another.
    """
    if left.kind == "letter" or (left.kind == "call" and left.text == "size"):
        return True
    alone = exact.shape == (1, 1)
    return (alone and exact[0, 0].is_constant and printed[0, 0].is_constant) or (not alone and wrong == 1)
