"""Functions of parameters in the data of a plant: cos θ and sin θ, e⁻ᵀ, roots.

Each is a generator, a letter of its own; what is known of it are the polynomials that vanish, cos² θ + sin² θ = 1, and
its sign.  What no polynomial says, that e⁻ᵀ decreases with T, is known to nobody here: answers then hold for all values of
the letters, those that occur among them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.conditions import sign_of
from symobs.errors import InputError
from symobs.exact.core.generators import function_named, identities

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.exact import Matrix, Scalar


def over_a_base(
    matrices: Mapping[str, Matrix | None], signs: Mapping[str, str], where: str = "plant"
) -> tuple[dict[str, Matrix | None], tuple[Scalar, ...]]:
    """Return matrices with their functions in a common base, and the polynomials in the base that vanish.

    Raises `InputError` for a function of time, and for a square root of what may be negative.
    """
    given = [matrix for matrix in matrices.values() if matrix is not None]
    functions = {f for matrix in given for name in matrix.names if (f := function_named(name)) is not None}
    if all(f.square for f in functions):
        return dict(matrices), ()
    for f in sorted(functions, key=lambda f: f.text):
        if f.symbols & {"t", "s", "z"}:
            message = f"{f.text} is a function of {', '.join(f.symbols & {'t', 's', 'z'})}"
            raise InputError(message, where=where, repair="entries are rational in t, and have no s or z")
        if f.kind == "sqrt" and not f.square and sign_of(f.argument, signs) not in {"positive", "nonnegative"}:
            message = f"{f.text}: {f.argument} may be negative"
            raise InputError(message, where=where, repair="declare the sign of its symbols, positive for example")
    meanings, relations = identities(given)
    moved = {name: None if matrix is None else _in_base(matrix, meanings) for name, matrix in matrices.items()}
    return moved, relations


def _in_base(matrix: Matrix, meanings: Mapping[str, Scalar]) -> Matrix:
    images = {name: meanings[name] for name in matrix.names if name in meanings}
    return matrix.substitute(images) if images else matrix


def is_identity(value: Scalar) -> bool:
    """Tell whether a polynomial vanishes because of what its functions are, as cos² θ + sin² θ − 1 does."""
    if not any(function_named(name) for name in value.names):
        return False
    return any(value in {relation, -relation} for relation in identities([value])[1])


