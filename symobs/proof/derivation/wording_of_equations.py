"""What sentences say of matrix equations: Lyapunov's, Riccati's, the regulator's, Gramians, and what refutes them (trusted)."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import EIGENVALUE, Matrix, Scalar, rank, transfer
from symobs.exact.algebraic.dead_time_margins import WORDS_OF_DEAD_TIME, pade_error, told_of_dead_time
from symobs.exact.algebraic.loop_distances import INFINITE, MARGIN_DIGITS, Loop
from symobs.exact.algebraic.nyquist import told_of
from symobs.exact.algebraic.root_loci import landmarks
from symobs.exact.core.generators import function_named
from symobs.exact.floating.riccati_check import Regulator, excess, is_proved
from symobs.formula.tree import (
    Apply,
    Decimals,
    Exact,
    Formula,
    Letter,
    Literal,
    Product,
    Quotient,
    Relation,
    Roots,
    SymbolList,
    evaluate,
    letters,
)
from symobs.formula.tree.written import written
from symobs.proof.certificate.claims import as_scalar
from symobs.proof.derivation.facts import leading_minors
from symobs.proof.derivation.sentence_context import (
    SentenceContext,
    characteristic_of,
    ideal,
    is_not_zero,
    is_shown_in,
    is_value,
    letter_of,
    number_of,
    sizes_of,
    vanishes,
)
from symobs.proof.derivation.steps import literals
from symobs.system.conditions import sign_of, sign_where

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.formula.tree import Environment


def vanishes_of(said: SentenceContext, *names: str) -> bool:
    """Return whether the step has a product of these letters alone, the last one's columns independent, that is 0."""
    basis = letter_of(names[-1] if names[-1] in said.environment.values else "N")
    here, relations = said.environment, said.of(Relation)
    products = [first for first in (relation.members[0] for relation in relations) if isinstance(first, Product)]
    wanted = {*names[:-1], *letters(basis)}
    found = [each for each in products if letters(each) == wanted and next(literals(each), None) is None]
    columns = Apply("rank", basis), number_of(evaluate(basis, here, Exact(here)).shape[1])
    return any(vanishes(here, each) for each in found) and is_shown_in(here, columns[0], "=", columns[1])


def annuls(said: SentenceContext, *names: str) -> bool:
    """Return whether a row times a matrix is 0, the row is not, nor is its product with the matrices that follow."""
    row, first, *others = names
    return said.holds(f"{row} ({first}) = 0", f"{row} !== 0", *(f"{row} ({other}) !== 0" for other in others))


def is_lower_rank(said: SentenceContext, C: str, E: str) -> bool:
    """Return whether C E w = 0 and E w ≠ 0 are told: the kernel of C E is then larger than that of E."""
    unseen, differs = (relation.members[0] for relation in said.of(Relation))
    along = differs.factors if isinstance(differs, Product) else (differs,)
    names_them = unseen == Product((letter_of(C), *along)) and along[0] == letter_of(E)
    return names_them and vanishes(said.environment, unseen) and is_not_zero(said.environment, differs)


def sums(said: SentenceContext, letter: str, count: int | None = None) -> bool:
    """Return whether a letter is Σ (Aᵀ)ᵏ Cᵀ C Aᵏ, or that of the dual, over so many powers: all n where none is given."""
    return any(_is_sum(said, letter, row, of, count) for row, of in (("C", "A"), ("Bᵀ", "Aᵀ")))


def _is_sum(said: SentenceContext, letter: str, row: str, of: str, count: int | None = None) -> bool:
    if not {letter, row.rstrip("ᵀ")} <= said.environment.values.keys():
        return False
    powers = [row, *(f"({row} {of}^{k})" for k in range(1, said.size(of)[0] if count is None else count))]
    return said.holds(f"{letter} = " + " + ".join(f"{power}ᵀ {power}" for power in powers))


def shares_kernel(said: SentenceContext, row: str, of: str) -> bool:
    """Return whether W has the kernel of M, the sum over n powers: as an integral, or as a sum over all steps.

    An integral over any time has it; a sum has it where it solves W − AᵀWA = CᵀC, and not over every number of steps.
    """
    is_sum = said.environment.variable == "z"
    return _is_sum(said, "M", row, of) and (not is_sum or said.holds(f"{of}ᵀ W {of} - W = -({row}ᵀ {row})"))


def is_nonsingular(said: SentenceContext, letter: str) -> bool:
    """Return whether the determinant of a letter vanishes nowhere."""
    return said.holds(f"det({letter}) != 0")


def spans_kernel(said: SentenceContext) -> bool:
    """Return whether the columns of v (or N) are a basis of the kernel of W."""
    N = "v" if "v" in said.environment.values else "N"
    order, vectors = said.size(N)
    return said.holds(f"rank(W) = {order - vectors}", f"rank({N}) = {vectors}", f"W {N} = 0")


def _left_side(said: SentenceContext, of: str, P: str) -> str:
    """Return AᵀP + PA, in discrete time AᵀPA − P."""
    return f"{of}ᵀ {P} {of} - {P}" if said.environment.variable == "z" else f"{of}ᵀ {P} + {P} {of}"


def reverses(here: Environment, letter: str, of: str) -> bool:
    """Return whether a polynomial has the coefficients of another in reverse order."""
    own, other = (as_scalar(here.values[name]) for name in (letter, of))
    coefficients = tuple(reversed(other.coefficients(here.variable)))
    return own == sum(
        (c * Scalar.symbol(here.variable) ** k for k, c in enumerate(reversed(coefficients))), Scalar.of(0)
    )


def is_of_pairs(said: SentenceContext, of: str) -> bool:
    """Return whether what is told is det χ(−A), in discrete time det χ*(A)."""
    discrete, told = said.environment.variable == "z", said.of(Relation)
    image = written(f"det(chi_r_at({of}))" if discrete else f"det(chi_at(-{of}))", said.environment).formula
    known = said.holds(f"chi = det(pencil({of}))") and (not discrete or reverses(said.environment, "chi_r", "chi"))
    return known and bool(told) and all(relation.members[0] == image for relation in told)


def solves_homogeneous(said: SentenceContext, of: str, N: str) -> bool:
    """Return whether a symmetric matrix other than 0 solves Lyapunov's equation with 0 on the right."""
    return said.holds(f"{N} = {N}ᵀ", f"{_left_side(said, of, N)} = 0", f"{N} !== 0")


def _trace(said: SentenceContext, left: str, right: str) -> Scalar:
    """Return the trace of a product of two letters."""
    pair = (written(text, said.environment).value.entries for text in (f"{left}ᵀ", right))
    return sum((a * b for a, b in zip(*pair, strict=True)), Scalar.of(0))


def refutes_lyapunov(said: SentenceContext, of: str, Q: str, X: str) -> bool:
    """Return whether X, symmetric, solves the transposed homogeneous equation and the trace told is that of Q X, and not 0."""
    adjoint = f"{of} {X} {of}ᵀ - {X} = 0" if said.environment.variable == "z" else f"{of} {X} + {X} {of}ᵀ = 0"
    slots = {"told": said.told("trace"), "trace": _trace(said, Q, X)}
    return said.holds(f"{Q} = {Q}ᵀ", f"{X} = {X}ᵀ", adjoint, "{told} = {trace}", "{trace} !== 0", **slots)


def refutes_regulator(said: SentenceContext, *disturbs: str) -> bool:
    """Return whether U A + V C = S U, U B + V D = 0, and what is told is tr UE − tr VQ (tr VQ where E is 0), and not 0."""
    known = said.environment.values
    if not disturbs and "E_d" in known and said.holds("E_d !== 0"):
        return False
    trace = _trace(said, "V_r", "Q_r")
    trace = _trace(said, "U_r", *disturbs) - trace if disturbs else trace
    slots = {"told": said.told("trace"), "trace": trace}
    driven = "U_r B + V_r D = 0" if "D" in known else "U_r B = 0"
    return said.holds("U_r A + V_r C = S_w U_r", driven, "{told} = {trace}", "{trace} !== 0", **slots)


def is_blocked(said: SentenceContext, of: str, *, everywhere: bool) -> bool:
    """Return whether [A − sI, B; C, D] has less than n + p independent rows at the roots told, eigenvalues of a matrix.

    Where that is not so for every s, these are zeros of the plant.
    """
    here, told, s = said.environment, said.slots["modes"], Scalar.symbol(said.environment.variable)
    A, B, C = (evaluate(Letter(name), here, Exact(here)) for name in "ABC")
    D = evaluate(Letter("D"), here, Exact(here)) if "D" in here.values else Matrix.zeros(C.shape[0], B.shape[1])
    full = A.shape[0] + C.shape[0]
    own = Matrix.block([[A - Matrix.identity(A.shape[0]) * s, B], [C, D]])
    shown = all(
        isinstance(slot := said.slots[name], Formula) and is_shown_in(here, slot, "=", Literal(value))
        for name, value in (("pencil", own), ("size", Scalar.of(full)))
    )
    if not shown or not isinstance(told, Roots) or (everywhere == (rank(own, ideal(here.relations)) == full)):
        return False
    polynomial = as_scalar(evaluate(told.polynomial, here, Exact(here)))
    eigenvalue = {here.variable: Scalar.symbol(EIGENVALUE)}
    there = own.substitute(eigenvalue)
    factors = [f.substitute(eigenvalue) for f, _ in polynomial.numerator.factors()[1] if here.variable in f.names]
    lost = all(rank(there, ideal((*here.relations, factor))) < full for factor in factors)
    return (
        bool(factors) and lost and is_value(here, "polynomial", Quotient(characteristic_of(of, here), told.polynomial))
    )


def has_margins(said: SentenceContext, closed: str, opened: str) -> bool:
    """Return whether angle, distance and peak are told of a stable loop as they round; no angle where there is none."""
    here, discrete = said.environment, said.environment.variable == "z"
    known = (as_scalar(evaluate(Letter(name), here, Exact(here))) for name in (closed, opened))
    parts = [[entry.fraction() for entry in value.coefficients(here.variable)] for value in known]
    loop = Loop.of(*parts, discrete=discrete)
    found = {"modulus": loop.modulus(MARGIN_DIGITS), "peak": loop.peak(MARGIN_DIGITS)}
    phase = loop.phase(MARGIN_DIGITS)
    found |= {} if phase == INFINITE else {"phase": phase}
    told = {name: slot.value for name, slot in said.slots.items() if isinstance(slot, Decimals)}
    right = {name: None if text is None else Scalar.of(Fraction(text)) for name, text in found.items()}
    return told == right and told.keys() == said.slots.keys() and is_value(here, "stable", Letter(closed))


def has_nyquist(said: SentenceContext, kind: str, closed: str, opened: str) -> bool:
    """Return whether the counts, or the digits of a crossing or of the delay margin are told of the loop N/P."""
    here = said.environment
    first, second = (as_scalar(evaluate(Letter(name), here, Exact(here))) for name in (closed, opened))
    told = {n: as_scalar(x.value).fraction() if isinstance(x, Decimals) else x for n, x in said.slots.items()}
    right = told_of(kind, first, second, here.variable)
    return told in [{n: t if kind == "counts" else Fraction(t) for n, t in each.items()} for each in right]


def has_dead_time(said: SentenceContext, kind: str, moved: str, opened: str, delay: str) -> bool:
    """Return whether the counts or the digits of a kind are told of the loop k N/P e^{−sT}."""
    here, slots = said.environment, dict(said.slots)
    P, N, T = (as_scalar(evaluate(Letter(name), here, Exact(here))) for name in (opened, moved, delay))
    gain = slots.pop("gain", None)
    sign = here.signs.get(gain.names[0], "real") if isinstance(gain, SymbolList) else "real"
    told = {n: as_scalar(x.value).fraction() if isinstance(x, Decimals) else x for n, x in slots.items()}
    right = told_of_dead_time(kind, P, N, T, sign)
    return told in [{n: t if n in WORDS_OF_DEAD_TIME else Fraction(t) for n, t in each.items()} for each in right]


def misses_phase(said: SentenceContext, delay: str) -> bool:
    """Return whether the error of a Padé approximation is told at a crossover of the plant, which has it at its input."""
    here = said.environment
    A, B, C = (evaluate(Letter(name), here, Exact(here)) for name in "ABC")
    found = transfer(A, B, C, as_scalar(here.values.get("D", Scalar.of(0))), here.variable)
    right = pade_error(*found, as_scalar(evaluate(Letter(delay), here, Exact(here))), int(str(said.slots["order"])))
    told = {n: as_scalar(x.value).fraction() for n, x in said.slots.items() if isinstance(x, Decimals)}
    return told in [{n: Fraction(t) for n, t in each.items()} for each in right]


def is_real_point(said: SentenceContext) -> bool:
    """Return whether the values shown are real and have the signs declared for their names, in the case they stand in."""
    here, names = said.environment, said.slots["names"]
    shown = said.told("values").formula if "values" in said.slots else said.of(Relation)[0].members[-1]
    value = evaluate(shown, here, Exact(here))
    entries = value.entries if isinstance(value, Matrix) else (value,)
    if not isinstance(names, SymbolList) or len(names.names) != len(entries):
        return False

    def sign(number: Scalar) -> str:
        return sign_where(number.numerator * number.denominator, here.signs, here.positive)  # it has a value there

    def is_real(number: Scalar) -> bool:
        found = [f for f in map(function_named, number.names) if f is not None and f.kind in _REAL_WHERE]
        return all(sign(_REAL_WHERE[f.kind](f.argument)) in _NOT_NEGATIVE and is_real(f.argument) for f in found)

    wanted = [_FITS.get(here.signs.get(name, "real")) for name in names.names]
    return all(is_real(x) and (fits is None or sign(x) in fits) for x, fits in zip(entries, wanted, strict=True))


_NOT_NEGATIVE = frozenset(("positive", "nonnegative", "zero"))
#: What is not negative where a function is real, and the signs that fit to a declared one.
_REAL_WHERE = {"sqrt": lambda x: x, "acos": lambda x: 1 - x**2, "asin": lambda x: 1 - x**2}
_FITS = {
    "positive": {"positive"},
    "negative": {"negative"},
    "nonnegative": _NOT_NEGATIVE,
    "nonpositive": {"negative", "nonpositive", "zero"},
    "nonzero": {"positive", "negative", "nonzero"},
}


def is_on_locus(said: SentenceContext, kind: str, opened: str, moved: str) -> bool:
    """Return whether the numbers told are those of a landmark of the root locus p + k q."""
    here = said.environment
    p, q = (as_scalar(evaluate(Letter(name), here, Exact(here))) for name in (opened, moved))
    told = {name: as_scalar(slot.value).fraction() for name, slot in said.slots.items() if isinstance(slot, Decimals)}
    return told.keys() == said.slots.keys() and told in landmarks(kind, p, q, here.variable)


def leads_with(said: SentenceContext, letter: str, sign: str) -> bool:
    """Return whether the leading coefficient of a polynomial has a sign."""
    here = said.environment
    lead = as_scalar(evaluate(Letter(letter), here, Exact(here))).coefficients(here.variable)[0]
    return sign_of(lead, here.signs) == sign


def has_asymptotes(said: SentenceContext, opened: str, moved: str) -> bool:
    """Return whether n − m and (Σ poles − Σ zeros)/(n − m) are told of p + k q."""
    here = said.environment
    p, q = (as_scalar(evaluate(Letter(n), here, Exact(here))).coefficients(here.variable) for n in (opened, moved))
    sums = [-c[1] / c[0] if len(c) > 1 else Scalar.of(0) for c in (p, q)]
    excess = len(p) - len(q)
    return said.slots["excess"] == str(excess) and said.told("centroid").value * excess == sums[0] - sums[1]


def are_minors(said: SentenceContext, of: str) -> bool:
    """Return whether Δ₁, Δ₂, … are the leading principal minors of a matrix."""
    here, order = said.environment, sizes_of(of, said.environment)[0]
    matrix = evaluate(Letter(of), here, Exact(here))
    parts = [matrix.select(range(k), range(k)) for k in range(1, order + 1)]
    names = [name for name in here.values if name.startswith("Delta_")]
    return len(names) == order and all(
        is_shown_in(here, Letter(f"Delta_{k}"), "=", Apply("det", Literal(part))) for k, part in enumerate(parts, 1)
    )


def is_lyapunov(said: SentenceContext, P: str, Q: str, of: str) -> bool:
    """Return whether P solves Lyapunov's equation, Q is said to be positive definite, and χ to be stable or not."""
    told = said.subjects("positive_definite"), said.subjects("stable", "unstable")
    solves = said.holds(f"{_left_side(said, of, P)} = -{Q}", f"chi = det(pencil({of}))")
    return solves and told == ([Letter(Q)], [Letter("chi")])


def is_optimal(said: SentenceContext, of: str, by: str, Q: str, R: str, N: str, P: str, K: str, chi: str) -> bool:
    """Return whether P solves Riccati's equation, weights have their signs, and χ, said to be stable, is of the loop with K."""
    here, discrete = said.environment, said.environment.variable == "z"
    problem = Regulator(*(written(each, here).value for each in (of, by, Q, R, N)), discrete)  # type: ignore[call-arg]
    signs = {sign_of(c, here.signs) for c in (-problem.uncrossed[2]).characteristic_polynomial("s").coefficients("s")}
    definite = all(sign_of(minor, here.signs) == "positive" for minor in leading_minors(problem.R))
    inner = f"({R} + {by}ᵀ {P} {by})" if discrete else R
    coupled = f"{by}ᵀ {P} {of} + {N}ᵀ" if discrete else f"{by}ᵀ {P} + {N}ᵀ"
    solves = said.holds(f"{_left_side(said, of, P)} + {Q} = {K}ᵀ {inner} {K}", f"{P} = {P}ᵀ")
    loops = (
        said.holds(f"{inner} {gain} = {coupled}", f"{chi} = det(pencil({of}) + {by} {gain})")
        for gain in (K, f"(-{K})")  # minus the gain in the signs of some conventions: the result holds its own letter
    )
    known = definite and signs <= {"positive", "nonnegative", "zero"} and said.subjects("stable") == [Letter(chi)]
    return known and solves and any(loops)


def encloses(said: SentenceContext, *names: str) -> bool:
    """Return whether P and K, or −K, are those of the stabilising solution, rounded to the decimal places told."""
    return any(_rounded_optima(said, _told_number(said, "radius"), names))


def _rounded_optima(
    said: SentenceContext, unit: Fraction, names: Sequence[str]
) -> Iterator[tuple[Regulator, Matrix, Matrix]]:
    """Yield the problem with P and K or −K, where these are the solution, rounded to multiples of a power of ten."""
    here = said.environment
    *data, P, K = (evaluate(letter_of(name), here, Exact(here)) for name in names)
    problem = Regulator(*data, here.variable == "z")  # type: ignore[call-arg]
    ends = str(1 / unit).strip("0") == "1" and not any(1 / unit % M.common_denominator().fraction() for M in (P, K))
    told = [[[(entry.fraction(), unit / 2) for entry in row] for row in M.rows] for M in (P, K, -K)]
    for gain, rows in zip((K, -K), told[1:], strict=True):
        if ends and is_proved(problem, P, unit, told[0], rows):
            yield problem, P, gain


def _told_number(said: SentenceContext, slot: str) -> Fraction:
    here = said.environment
    return as_scalar(evaluate(said.slots[slot], here, Exact(here))).fraction()  # type: ignore[arg-type]


def exceeds(said: SentenceContext, *names: str) -> bool:
    """Return whether the bound told is the smallest power of ten found for the cost of K, or −K, rounded as told."""
    unit, told = _told_number(said, "radius"), _told_number(said, "bound")
    return any(excess(problem, P, gain, unit) == told for problem, P, gain in _rounded_optima(said, unit, names))


def reaches(said: SentenceContext, of: str) -> bool:
    """Return whether the largest absolute value of a matrix is at least what is told, and less than ten times that."""
    largest = max(abs(entry.fraction()) for entry in said.environment.values[of].entries)  # type: ignore[union-attr]
    return bool(_told_number(said, "bound") <= largest < 10 * _told_number(said, "bound"))


def splits(said: SentenceContext, even: str, of: str) -> bool:
    """Return whether a polynomial is that of the stable monic p times its mirror image, up to a number."""
    here, v = said.environment, said.environment.variable
    whole, p = (as_scalar(here.values[name]) for name in (even, of))
    s, is_monic = Scalar.symbol(v), p.coefficients(v)[0].is_one
    product = p * (p.substitute({v: 1 / s}) * s ** p.degree(v) if v == "z" else p.substitute({v: -s}))
    number = whole.coefficients(v)[0] / product.coefficients(v)[0]
    same = is_shown_in(here, Letter(even), "=", Literal(number * product))
    return is_monic and same and is_value(here, "stable", Letter(of))
