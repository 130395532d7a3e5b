"""Claims of gain designs: why there is no gain, that an algebraic one exists, zeros in given places, and freedom (trusted)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import EIGENVALUE, Matrix, Scalar, independent_rows
from symobs.formula.tree import Environment, Literal
from symobs.formula.tree.term import Term
from symobs.ground.errors import CertificateRejected
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.tasks.design.pole_placement.zero_pattern import with_zeros
from symobs.tasks.result import equality, holds

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.gain.gain_kind import Places
    from symobs.tasks.design.pole_placement.single_output import ObserverPair
    from symobs.tasks.design.pole_placement.zero_pattern import RootGain


def unassignable_claims(pair: ObserverPair, polynomial: Scalar) -> Iterator[Claim]:
    """Yield C N = 0 and A N = N X, which make det(sI − X) a factor of every det(sI − A + LC), and that it does not divide φ."""
    quotient, rest = pair.divided(polynomial)
    N, X = pair.kernel, pair.restricted
    values: dict[str, Scalar | Matrix] = {"A": pair.A, "C": pair.c, "N": N, "X": X, "phi": polynomial}
    e = Environment(variable=pair.variable, values=values)
    yield holds(e, "C N = 0")
    yield holds(e, "A N = N X")
    yield Claim(relation(N.shape[1], X.shape[0], "!==", 0), e, "X has the order of the kernel")
    yield _of_full_rank(pair, e)
    yield holds(e, "det(pencil(X)) = {fixed_polynomial}", fixed_polynomial=pair.fixed_polynomial)
    phi = e["phi"]
    yield equality(phi, pair.fixed_polynomial * quotient + rest, e)
    yield Claim(relation(Term(Literal(rest), e), "!==", 0), e)


def claims_of_kernel_family(
    pair: ObserverPair,
    gain: Matrix,
    general: Matrix,
    names: Sequence[str],
    transpose_for_task: Callable[[Matrix], Matrix],
    letter_of_gain: str,
) -> Iterator[Claim]:
    """Yield L = L₀ + N g with N of full rank: no parameter of the family is idle."""
    e = Environment(variable=pair.variable)
    free = Matrix.column([Scalar.symbol(name) for name in names])
    expected = (gain + transpose_for_task(pair.kernel @ free)).normal()
    yield equality(general, expected, e, f"{letter_of_gain} is free along the kernel")
    yield _of_full_rank(pair, e)


def _of_full_rank(pair: ObserverPair, e: Environment) -> Claim:
    """Return the claim that the columns of N, the kernel of 𝒪, are independent."""
    N = pair.kernel
    minor = N.select(independent_rows(N, pair.ideal), range(N.shape[1]))
    return Claim(relation(Term(Literal(minor), e).apply("det"), "!==", 0), e, "N has full rank")


def excluded_claims(
    pair: ObserverPair,
    desired: DesiredPolynomial,
    places: Places,
    equations: Sequence[Scalar],
    needed: Sequence[Scalar] | None,
    letter_of_gain: str,
) -> Iterator[Claim]:
    """Yield the claim that necessary conditions of such a gain lie in the ideal of the equations.

    Where nothing is needed the answer says no more than that no gain was found: raises `CertificateRejected` if one is.
    """
    if not needed and with_zeros(pair, desired, places) is not None:
        raise CertificateRejected(f"a gain {letter_of_gain} with these zeros is found")
    e = Environment(variable=pair.variable, relations=tuple(equations))
    for value in needed or ():
        says = f"with zeros there, {value} lies in the ideal of the coefficients of det(s*I - A + L*C) - phi(s)"
        yield equality(value, 0, e, says if letter_of_gain == "L" else says.replace("L*C", "B*K"))
        if not value.is_constant:
            yield Claim(relation(value, "!==", 0), Environment(variable=pair.variable))


def has_real_root(found: RootGain, e: Environment) -> Claim:
    """Return the claim that the polynomial of an algebraic gain changes its sign between its bounds."""
    low, high = (found.polynomial.substitute({EIGENVALUE: Scalar.of(end)}) for end in found.bounds)
    return Claim(relation(low * high, "<", 0), e, f"{found.polynomial} has a real root")


def zeros_claim(gain: Matrix, zero: Places, letter_of_gain: str, e: Environment) -> Claim:
    """Return the claim that a gain has its zeros in the given places."""
    entries = Matrix.row([gain[i, j] for i, j in zero])
    return equality(entries, Matrix.zeros(1, len(zero)), e, f"zeros in {letter_of_gain} as asked for")
