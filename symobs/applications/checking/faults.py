"""Why an answer is wrong: the slips that reproduce it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, replace
from functools import partial
from itertools import combinations
from typing import TYPE_CHECKING, Any

from symobs.applications.audit import differences
from symobs.exact import Matrix, Scalar, product_of, transfer_matrix
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected
from symobs.tasks.design.compensator.compensator import CompensatorDesign

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.gain.gain_design import GainDesign
    from symobs.tasks.result import Result


# A fault: one change of the right answer, or of what it was computed from, that gives the student's value.


@dataclass
class Fault:
    """The slip by its name, the reason in words, and the place: `[row, column]` or `{"coefficient": 1}`."""

    slip: str
    reason: str
    place: Any = None


@dataclass
class Explained:
    """Why a part is wrong: the slip, None where none was found, other ones that fit as well, and what the value does."""

    slip: str | None = None
    reason: str = ""
    place: Any = None
    alternatives: tuple[Fault, ...] = ()
    effect: Mapping[str, str] = field(default_factory=dict)
    tried: int = 0


#: Finds the faults of one kind that reproduce a value.
Kind = Callable[[], Iterable[Fault]]


def is_empty_but_for(value: Matrix, i: int, j: int) -> bool:
    """Return whether all other entries of a matrix are zero, so that this one is all that there is to find."""
    return all(entry.is_zero for a, row in enumerate(value.rows) for b, entry in enumerate(row) if (a, b) != (i, j))


def first_kind(kinds: Iterable[Kind]) -> Explained:
    """Return the fault of the first kind that reproduces the value; several of one kind are ambiguous."""
    tried = 0
    for kind in kinds:
        tried += 1
        found = list({(fault.slip, fault.reason): fault for fault in kind()}.values())
        if len(found) == 1:
            return Explained(found[0].slip, found[0].reason, found[0].place, tried=tried)
        if found:
            return Explained("ambiguous", "one of several slips", None, tuple(found), tried=tried)
    return Explained(tried=tried)


# Faults of a gain: slips in the gain itself, then in what it was computed from.
#
# Each is tried on the student's value: a slip in the data is one of which det(sI − A + LC) = φ(s) holds for the changed
# data, one in the result is one that, undone, gives a gain whose claim holds.


#: Entries of the data whose sign is changed one by one, before the search is given up.
MOST_ENTRIES = 150
#: Entries that are exchanged in pairs; entries whose signs are changed together.
MOST_EXCHANGED, MOST_SIGNS = 12, 6


def explain_gain(
    design: GainDesign, value: Matrix, letter: str, other: Scalar | None, *, turned: bool, rounded: bool
) -> Explained:
    """Return why a gain is wrong; `other` is the polynomial of the other half of a compensator.

    `turned` says that the letter denotes the negative gain in the student's convention.
    """
    right = design.answer[design.letter]
    pair = design.dual_pair(design.plant)
    if design.transpose_for_task(value).shape != (pair.A.shape[0], pair.c.shape[0]):
        return first_kind([partial(_transposed, design, value, letter)])
    search = _Search(design, value, letter, other, turned=turned)
    kinds: list[Kind] = [search.sign]
    if rounded:
        kinds.append(lambda: [Fault("rounded", f"{letter} is rounded, and its exact value is asked for")])
    if design.desired is not None and right is not None:
        kinds += [search.entry, search.one_coefficient, search.other_half]
        kinds += [search.factor, search.exchanged, search.sign_entries]
        kinds += [search.mirrored, search.pole_repeated, search.pole_dropped, search.not_subtracted, search.reversed]
        kinds += [search.dual_untransposed, search.other_matrix, search.not_transformed, search.wrong_direction]
        kinds += [search.entry_misread]
    return replace(first_kind(kinds), effect=search.effect)


def _transposed(design: GainDesign, value: Matrix, letter: str) -> Iterator[Fault]:
    if _is_right(design, value.T):
        yield Fault("transposed", f"the transpose of {letter} is right")


def _is_right(design: GainDesign, gain: Matrix) -> bool:
    """Return whether the claim of the design holds for a gain."""
    right = design.answer[design.letter]
    if right is None or gain.shape != right.shape:
        return False
    try:
        design.with_answer(design.letter, gain)
    except CertificateRejected:
        return False
    return True


class _Search:
    """The kinds of faults of one wrong gain.  A and C are those of the observer problem that the design is or is dual to."""

    def __init__(self, design: GainDesign, value: Matrix, letter: str, other: Scalar | None, *, turned: bool) -> None:
        self.design, self.value, self.letter, self.other, self.turned = design, value, letter, other, turned
        self.s = design.plant.variable
        pair = design.dual_pair(design.plant)
        self.A, self.C = pair.A, pair.c
        self.L = design.transpose_for_task(value)
        self.phi: Scalar = design.answer["polynomial"]
        self.mine = self.closed(self.A, self.C)

    def closed(self, A: Matrix, C: Matrix, L: Matrix | None = None) -> Scalar:
        """Return det(sI − A + LC) with the student's L."""
        return (A - (self.L if L is None else L) @ C).normal().characteristic_polynomial(self.s)

    @property
    def effect(self) -> dict[str, str]:
        """What the student's gain does."""
        given = type(self.design).of_given(self.design.plant, self.value)
        return {"polynomial": str(given.answer["polynomial"]), "stable": given.stability.verdict}

    @property
    def matrix(self) -> str:
        """The matrix of the loop as the student's convention writes it."""
        sign = "+" if self.turned else "-"
        return f"A {sign} B {self.letter}" if self.design.letter == "K" else f"A {sign} {self.letter} C"

    # -- the result ---------------------------------------------------------------------------------------------------

    def sign(self) -> Iterator[Fault]:
        """Yield that −L is right, or L′ and −L′ of a square gain."""
        other = self.matrix.replace(" + ", " ! ").replace(" - ", " + ").replace(" ! ", " - ")
        if _is_right(self.design, -self.value):
            said = f"the sign of {self.letter}: with {self.matrix}, yours is the gain of {other}"
            yield Fault("sign", said)
        elif self.value.shape[0] == self.value.shape[1] and _is_right(self.design, self.value.T):
            yield Fault("transposed", f"the transpose of {self.letter} is right")

    def entry(self) -> Iterator[Fault]:
        """Yield the single entries whose change makes the gain right: det(sI − A + LC) is affine in each of them.

        A gain that is empty but for this entry has no slip in it: to tell the entry would be to tell the gain.
        """
        rows, columns = self.value.shape
        for i in range(rows):
            for j in range(columns):
                if is_empty_but_for(self.value, i, j):
                    continue
                step = Matrix.of([[int((a, b) == (i, j)) for b in range(columns)] for a in range(rows)])
                moved = self.closed(self.A, self.C, self.L + self.design.transpose_for_task(step))
                change = _factor(self.phi - self.mine, moved - self.mine, self.s)
                if change is None:
                    continue
                right = self.value + step * change
                if _is_right(self.design, right):
                    entry = -right[i, j] if self.turned else right[i, j]
                    said = f"entry ({i + 1},{j + 1}) should be {entry} with the others as they are"
                    yield Fault("entry", said, [i + 1, j + 1])

    def one_coefficient(self) -> Iterator[Fault]:
        """Yield the coefficient in which the polynomial alone differs from the one asked for."""
        pairs = list(zip(self.mine.coefficients(self.s), self.phi.coefficients(self.s), strict=True))
        off = [(len(pairs) - 1 - k, mine, asked) for k, (mine, asked) in enumerate(pairs) if mine != asked]
        if len(off) == 1:
            power, mine, asked = off[0]
            name = (
                "the constant term" if not power else f"the coefficient of {self.s}{f'^{power}' if power > 1 else ''}"
            )
            yield Fault("one_coefficient", f"{name} of the polynomial is {mine}, not {asked}", {"coefficient": power})

    def factor(self) -> Iterator[Fault]:
        """Yield that every entry is multiplied by one number, which the trace of the loop's matrix tells."""
        chi, asked, mine = (p.coefficients(self.s)[1] for p in (self._delta()[0], self.phi, self.mine))
        if chi in (asked, mine):
            return
        times = (mine - chi) / (asked - chi)
        if times.is_constant and _is_right(self.design, self.value * (Scalar.of(1) / times)):
            yield Fault("factor", f"every entry of {self.letter} is multiplied by {times}")

    def exchanged(self) -> Iterator[Fault]:
        """Yield two entries that stand in each other's place."""
        for (i, j), (k, m) in combinations(self._places(), 2):
            one, other = self.value[i, j], self.value[k, m]
            if one != other and self._meets(_with(_with(self.value, i, j, other), k, m, one)):
                said = f"the entries ({i + 1},{j + 1}) and ({k + 1},{m + 1}) are exchanged"
                yield Fault("exchanged", said)

    def sign_entries(self) -> Iterator[Fault]:
        """Yield the entries, several but not all, that have the other sign."""
        filled = [place for place in self._places() if not self.value[place].is_zero]
        for count in range(2, len(filled) if len(filled) <= MOST_SIGNS else 0):
            for chosen in combinations(filled, count):
                turned = self.value
                for i, j in chosen:
                    turned = _with(turned, i, j, -self.value[i, j])
                if self._meets(turned):
                    yield Fault("sign_entries", f"{count} entries of {self.letter} have the other sign")

    def _places(self) -> list[tuple[int, int]]:
        rows, columns = self.value.shape
        return [(i, j) for i in range(rows) for j in range(columns)][:MOST_EXCHANGED]

    def _meets(self, gain: Matrix) -> bool:
        """Return whether a gain is right, its polynomial being found first."""
        mine = self.closed(self.A, self.C, self.design.transpose_for_task(gain))
        return mine == self.phi and _is_right(self.design, gain)

    # -- the polynomial -----------------------------------------------------------------------------------------------

    def _of(self, polynomial: Scalar, slip: str, reason: str) -> Iterator[Fault]:
        if self.mine == polynomial:
            yield Fault(slip, reason)

    def other_half(self) -> Iterator[Fault]:
        """Yield that the poles of the other half of the compensator were taken."""
        if self.other is not None:
            own, other = ("control", "observer") if self.design.letter == "K" else ("observer", "control")
            said = f"{self.letter} places the {other} poles in place of the {own} poles"
            yield from self._of(self.other, "other_half", said)

    def mirrored(self) -> Iterator[Fault]:
        """Yield that the poles were taken with the other sign."""
        order = self.phi.degree(self.s)
        turned = self.phi.substitute({self.s: -Scalar.symbol(self.s)}) * (-1) ** order
        yield from self._of(turned, "mirrored", "the poles are taken with the other sign")

    def _poles(self) -> tuple[DesiredPolynomial, list[Scalar]]:
        desired = self.design.desired
        assert desired is not None  # noqa: S101 - asked only of designs for poles
        real = [Scalar.symbol(self.s) - pole.real for pole in desired.poles if pole.is_real]
        return desired, real

    def pole_repeated(self) -> Iterator[Fault]:
        """Yield that one pole was taken twice, in place of another."""
        _, real = self._poles()
        for dropped in dict.fromkeys(real):
            for kept in dict.fromkeys(real):
                if kept != dropped:
                    polynomial = self.phi / dropped * kept
                    said = f"the pole {_root(kept, self.s)} is taken in place of {_root(dropped, self.s)}"
                    yield from self._of(polynomial, "pole_repeated", said)

    def pole_dropped(self) -> Iterator[Fault]:
        """Yield that one pole was left out, so that 0 stands in its place."""
        desired, real = self._poles()
        s = Scalar.symbol(self.s)
        for dropped in dict.fromkeys(real):
            yield from self._of(
                self.phi / dropped * s, "pole_dropped", f"the pole {_root(dropped, self.s)} is left out"
            )
        factors = desired.factors
        for factor in dict.fromkeys(factor for factor in factors if factor.degree(self.s) > 1):
            rest = product_of([other for other in factors if other is not factor]) * s ** factor.degree(self.s)
            yield from self._of(rest, "pole_dropped", f"the factor {factor} is left out")

    def _delta(self) -> tuple[Scalar, list[Scalar]]:
        """Return χ and the coefficients of φ − χ, the highest first."""
        chi = self.A.characteristic_polynomial(self.s)
        pairs = zip(self.phi.coefficients(self.s), chi.coefficients(self.s), strict=True)
        return chi, [asked - own for asked, own in pairs][1:]

    def not_subtracted(self) -> Iterator[Fault]:
        """Yield that the coefficients of φ were taken in place of those of φ − χ."""
        chi, _ = self._delta()
        order = self.phi.degree(self.s)
        wrong = chi + self.phi - Scalar.symbol(self.s) ** order
        said = "the coefficients of the polynomial asked for are taken without subtracting those of the plant"
        if wrong != self.phi:
            yield from self._of(wrong, "not_subtracted", said)

    def reversed(self) -> Iterator[Fault]:
        """Yield that the coefficients of φ − χ were taken in reverse order."""
        chi, delta = self._delta()
        s = Scalar.symbol(self.s)
        turned = sum((c * s**k for k, c in enumerate(delta)), Scalar.of(0))
        yield from self._of(chi + turned, "reversed", "the coefficients are taken in reverse order")

    # -- the data -----------------------------------------------------------------------------------------------------

    def dual_untransposed(self) -> Iterator[Fault]:
        """Yield that A was taken for its transpose."""
        if self.A.T != self.A and self.closed(self.A.T, self.C) == self.phi:
            yield Fault("dual_untransposed", "A is taken for its transpose")

    def other_matrix(self) -> Iterator[Fault]:
        """Yield that B′ was taken for C, or C′ for B."""
        m = self.design.plant.matrices
        own, taken = ("B", "C'") if self.design.letter == "K" else ("C", "B'")
        instead = m.C if self.design.letter == "K" else m.B.T
        if instead.shape == self.C.shape and instead != self.C and self.closed(self.A, instead) == self.phi:
            yield Fault("other_matrix", f"{taken} is taken for {own}")

    def entry_misread(self) -> Iterator[Fault]:
        """Yield that one entry of the data was taken with the other sign."""
        feedback = self.design.letter == "K"
        tried = 0
        for name, data in (("A", self.A), ("B" if feedback else "C", self.C)):
            for i in range(data.shape[0]):
                for j in range(data.shape[1]):
                    if data[i, j].is_zero or tried >= MOST_ENTRIES:
                        continue
                    tried += 1
                    turned = _with(data, i, j, -data[i, j])
                    pair = (turned, self.C) if name == "A" else (self.A, turned)
                    if self.closed(*pair) == self.phi:
                        place = (j + 1, i + 1) if feedback else (i + 1, j + 1)
                        said = f"entry ({place[0]},{place[1]}) of {name} is taken with the other sign"
                        yield Fault("entry_misread", said, list(place))

    # -- coordinates --------------------------------------------------------------------------------------------------

    def _canonical(self) -> tuple[Matrix, Matrix] | None:
        """Return T of the observable form x̄ = T x, and L̄ there; None for several outputs, or where there is none."""
        if self.C.shape[0] != 1:
            return None
        rows = [self.C]
        while len(rows) < self.A.shape[0]:
            rows.append(rows[-1] @ self.A)
        chi, delta = self._delta()
        own = [Scalar.of(1), *chi.coefficients(self.s)[1:-1]]
        n = len(own)
        hankel = Matrix.of([[own[n - 1 - i - j] if i + j < n else Scalar.of(0) for j in range(n)] for i in range(n)])
        T = (hankel @ Matrix.block([[row] for row in rows])).normal()
        return None if T.determinant().is_zero else (T, Matrix.column(list(reversed(delta))))

    def not_transformed(self) -> Iterator[Fault]:
        """Yield that the gain in canonical coordinates was taken for the gain."""
        found = self._canonical()
        if found is not None:
            n = self.A.shape[0]
            turned = Matrix.column([found[1][n - 1 - i, 0] for i in range(n)])
            if self.L in {found[1], turned}:
                yield Fault("not_transformed", f"{self.letter} is the gain in canonical coordinates")

    def wrong_direction(self) -> Iterator[Fault]:
        """Yield that T was taken in place of its inverse."""
        found = self._canonical()
        if found is not None and (found[0] @ found[1]).normal() == self.L:
            yield Fault("wrong_direction", "T is taken in place of its inverse")


def _factor(wanted: Scalar, change: Scalar, s: str) -> Scalar | None:
    """Return t with wanted = t · change, None where there is no such number, or change is 0."""
    if change.is_zero:
        return None
    ratio = wanted / change
    return None if s in ratio.names else ratio


def _root(factor: Scalar, s: str) -> str:
    return str(Scalar.symbol(s) - factor)


def _with(matrix: Matrix, i: int, j: int, entry: Scalar) -> Matrix:
    rows = [[entry if (a, b) == (i, j) else cell for b, cell in enumerate(row)] for a, row in enumerate(matrix.rows)]
    return Matrix.of(rows)


# Faults of a value that is the only one: compared with the right one entry by entry, coefficient by coefficient.


#: The slips of a matrix as a whole that a comparison of entries finds.
_OF_THE_WHOLE = {"factor", "exchanged", "inverse"}


def explain_value(
    value: Matrix | Scalar,
    right: Matrix | Scalar,
    letter: str,
    variable: str,
    others: Iterable[tuple[str, Matrix | Scalar, str]],
    *,
    rounded: bool,
    in_loop: bool = False,
) -> Explained:
    """Return why a value is wrong; `others` are known slips in the way to it, each with its value and reason.

    With `in_loop` the value stands in a feedback loop, where its sign is a convention.
    """
    mine, exact = differences.as_matrix(value), differences.as_matrix(right)
    if mine.shape != exact.shape:
        if exact == mine.T:
            return Explained("transposed", f"the transpose of {letter} is right")
        sizes = " and ".join(f"{a}x{b}" for a, b in (exact.shape, mine.shape))
        return Explained(None, f"{letter} is {sizes.replace(' and ', ' here, yours is ')}")
    kinds = [partial(_rounded, letter)] if rounded else []
    kinds += [
        partial(_sign, mine, exact, letter, in_loop=in_loop),
        partial(_entry, mine, exact, letter, variable),
        partial(_known, value, others),
        partial(_specialised, mine, exact, letter, variable),
        partial(_whole, mine, exact, letter),
    ]
    return first_kind(kinds)


def _has_functions(mine: Matrix, exact: Matrix, variable: str) -> bool:
    """Return whether exponentials, sines and cosines of the time stand in one of two values."""
    return variable == "t" and not all(name.isidentifier() for name in mine.names | exact.names)


def _rounded(letter: str) -> Iterator[Fault]:
    yield Fault("rounded", f"{letter} is rounded, and its exact value is asked for")


def _sign(mine: Matrix, exact: Matrix, letter: str, *, in_loop: bool) -> Iterator[Fault]:
    if mine == -exact:
        if in_loop:
            yield Fault("sign_convention", f"-{letter} is right: yours is that of positive feedback")
        else:
            yield Fault("sign", f"-{letter} is right")
        return
    if exact == mine.T:
        yield Fault("transposed", f"the transpose of {letter} is right")
        return
    off = [(a, b) for a, b in zip(mine.entries, exact.entries, strict=True) if a != b]
    if len(off) > 1 and all(a == -b for a, b in off):
        yield Fault("sign_entries", f"{len(off)} entries of {letter} have the other sign")


def _entry(mine: Matrix, exact: Matrix, letter: str, variable: str) -> Iterator[Fault]:
    """Yield the one entry, or the one coefficient of a polynomial or a fraction, that is another one."""
    if exact.shape == (1, 1):
        if _has_functions(mine, exact, variable):  # they have no coefficients
            return
        off = _coefficients_off(mine[0, 0], exact[0, 0], variable)
        if len(off) == 1:
            ((of, power, came, right),) = off
            name = (
                "the constant term" if not power else f"the coefficient of {variable}{f'^{power}' if power > 1 else ''}"
            )
            place = {"coefficient": power} | ({"of": of} if of else {})
            yield Fault("one_coefficient", f"{name}{f' of the {of}' if of else ''} is {right}, not {came}", place)
        return
    wrong = differences.wrong_entries(mine, exact, whole=letter)
    if len(wrong) == 1:
        places = [(i, j) for i in range(exact.shape[0]) for j in range(exact.shape[1]) if mine[i, j] != exact[i, j]]
        (i, j), said = places[0], str(wrong[0])
        if is_empty_but_for(mine, i, j) or variable == "t":  # to tell the entry would be to tell the value
            said = f"entry ({i + 1}, {j + 1}) is wrong"
        yield Fault("entry", said, [i + 1, j + 1])


def _coefficients_off(mine: Scalar, exact: Scalar, variable: str) -> list[tuple[str, int, Scalar, Scalar]]:
    """Return where two polynomials, or two fractions with monic denominators, differ: the part, the power, both values."""
    if variable not in exact.names:
        return []
    pairs = [_parts(value, variable) for value in (mine, exact)]
    whole = all(below.is_one for _, below in pairs)
    found = []
    for place, of in enumerate(("",) if whole else ("numerator", "denominator")):
        one, other = pairs[0][place], pairs[1][place]
        for power in range(max(one.degree(variable), other.degree(variable)) + 1):
            came, right = _at(one, power, variable), _at(other, power, variable)
            if came != right:
                found.append((of, power, came, right))
    return found


def _parts(value: Scalar, variable: str) -> tuple[Scalar, Scalar]:
    """Return numerator and monic denominator."""
    if value.is_polynomial_in(variable):
        return value, Scalar.of(1)
    lead = value.denominator.coefficients(variable)[0]
    return value.numerator / lead, value.denominator / lead


def _at(polynomial: Scalar, power: int, variable: str) -> Scalar:
    coefficients = polynomial.coefficients(variable)
    return coefficients[len(coefficients) - 1 - power] if power < len(coefficients) else Scalar.of(0)


def _known(value: Matrix | Scalar, others: Iterable[tuple[str, Matrix | Scalar, str]]) -> Iterator[Fault]:
    for slip, wrong, reason in others:
        if type(wrong) is type(value) and wrong == value:
            yield Fault(slip, reason)


def _specialised(mine: Matrix, exact: Matrix, letter: str, variable: str) -> Iterator[Fault]:
    """Yield that 1 was put in place of the symbols."""
    names = exact.names - {variable, "t"}
    if names and not mine.names & names:
        try:
            at_one = exact.substitute({name: Scalar.of(1) for name in names if name.isidentifier()})
        except ZeroDivisionError:
            return
        if at_one == mine:
            yield Fault("specialised", f"{letter} is right for one value of the symbols only")


def _whole(mine: Matrix, exact: Matrix, letter: str) -> Iterator[Fault]:
    """Yield what is wrong with a matrix as a whole: a factor, an exchange, the inverse."""
    for piece in differences.reasons(mine, exact, letter).pieces:
        if isinstance(piece, differences.Remark) and piece.slip in _OF_THE_WHOLE:
            yield Fault(piece.slip, piece.said)


# Faults of F(s): the compensator with one term left out, or with one sign turned.


def other_values(result: Result) -> list[tuple[str, Matrix | Scalar, str]]:
    """Return what F is with each of the known slips: the slip, F, and the reason."""
    if not isinstance(result, CompensatorDesign) or not result.exists:
        return []
    return [(slip, _function(result, matrix), reason) for slip, matrix, reason in _matrices(result)]


def _matrices(result: CompensatorDesign) -> Iterator[tuple[str, Matrix, str]]:
    """Yield the matrix of the compensator's state with each of the slips."""
    m, K, L = result.plant.matrices, result.answer["K"], result.answer["L"]
    BK, LC, LDK = m.B @ K, L @ m.C, L @ m.D @ K
    yield "no_observer", m.A - BK, "the observer's own term L C is missing"
    yield "no_feedback", m.A - LC, "the term B K of the feedback is missing"
    yield "positive_feedback", m.A + BK - LC + LDK, "the feedback stands with the other sign"
    yield "sign_of_one", m.A - BK + LC + LDK, "the sign of L C is wrong"
    if K.shape == m.B.shape:
        yield "order_of_products", m.A - K @ m.B - LC + LDK, "K B stands for B K"
    if L.shape == m.C.shape:
        yield "order_of_products", m.A - BK - m.C @ L + LDK, "C L stands for L C"
    if m.has_feedthrough:
        yield "forgot_D", m.A - BK - LC, "D is taken as 0"


def _function(result: CompensatorDesign, matrix: Matrix) -> Matrix | Scalar:
    K, L, s = result.answer["K"], result.answer["L"], result.plant.variable
    zero = Matrix.zeros(K.shape[0], L.shape[1])
    above, below = transfer_matrix(matrix.normal(), L, K, zero, s)
    found = Matrix.of([[entry / below for entry in row] for row in above.rows])
    return found[0, 0] if found.shape == (1, 1) else found
