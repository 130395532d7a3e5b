"""All gains for several outputs: AᵀX − XF = CᵀG with F the companion matrix of φ and G free, L = (G X⁻¹)ᵀ.

Then (A − LC)ᵀ = X F X⁻¹, so det(sI − A + LC) = φ(s), repeated and irreducible φ included.  Every L for which A − LC is
cyclic is found by G = LᵀX.  G and G q(F) give the same L for every polynomial q, so one row w G may be held at e₁ᵀ;
what is left free are n(p − 1) parameters, and L determines them: with r = w Lᵀ and M = (A − LC)ᵀ the rows
r, rM, …, rMⁿ⁻¹ are X⁻¹.  Source: S. P. Bhattacharyya and E. de Souza, Systems & Control Letters 1 (1982), 261-263.
"""

from __future__ import annotations

from functools import cached_property
from itertools import count, islice
from math import comb
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, apply_polynomial, companion
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from symobs.exact import Ideal
    from symobs.proof.derivation.builder import Builder


#: Where placement by the equation comes from.
SYLVESTER = "bhattacharyya1982"
#: A general gain whose determinant could have more terms than this is not written out; of a plant with numbers it is no
#: more than the free parameters, and cases do not follow from it.
WRITTEN_UP_TO, WRITTEN_OF_NUMBERS = 60_000, 10_000


@dataclass
class Sylvester:
    """The equation (A − L₀C)ᵀX − XF = CᵀG for an observable pair; w G = e₁ᵀ, `names` stand for the other rows.

    `shift` is L₀, None where A and F have no eigenvalue in common.
    """

    A: Matrix
    C: Matrix
    factors: tuple[Scalar, ...]
    variable: str
    names: tuple[str, ...]
    shift: Matrix | None
    weights: tuple[int, ...]

    @cached_property
    def coefficients(self) -> tuple[Scalar, ...]:
        """The coefficients of φ after the leading one."""
        product = Scalar.of(1)
        for factor in self.factors:
            product = product * factor
        return product.coefficients(self.variable)[1:]

    @cached_property
    def F(self) -> Matrix:
        """The companion matrix of φ."""
        return companion(self.coefficients)

    @cached_property
    def shifted(self) -> Matrix:
        """A − L₀C."""
        return self.A if self.shift is None else self.A - self.shift @ self.C

    @cached_property
    def G(self) -> Matrix:
        """G with its free entries: all rows but the first with a weight, which makes w G = e₁ᵀ."""
        outputs, order = self.C.shape
        held = next(i for i, weight in enumerate(self.weights) if weight)
        free = iter([Scalar.symbol(name) for name in self.names])
        rows = [
            [Scalar.of(int(j == 0 and i == held)) if i == held else next(free) for j in range(order)]
            for i in range(outputs)
        ]
        for i, weight in enumerate(self.weights):
            if i != held and weight:
                rows[held] = [a - weight * b for a, b in zip(rows[held], rows[i], strict=True)]
        scale = self.weights[held]
        rows[held] = [entry / scale for entry in rows[held]]
        return Matrix.of(rows)

    def raised(self, G: Matrix) -> Matrix:
        """Return φ(Aᵀ)X: the columns are found from the last one, Cᵀ gₙ, by Horner's rule on φ.

        The solution for G = eᵢ eⱼᵀ is that for eᵢ e₁ᵀ times Fʲ⁻¹.
        """
        A, order = self.shifted, self.A.shape[0]
        total = Matrix.zeros(order, order)
        for i in range(self.C.shape[0]):
            last = self.C.select([i], range(order)).T
            columns = [last]
            for coefficient in self.coefficients[: order - 1]:
                columns.insert(0, A.T @ columns[0] + last * coefficient)
            part = Matrix.block([columns])
            for j in range(order):
                if not G[i, j].is_zero:
                    total = total + part * G[i, j]
                part = part @ self.F
        return total

    def solution(self, G: Matrix) -> Matrix:
        """Return X."""
        return self._at_A.T.solve(self.raised(G)).normal()

    @cached_property
    def _at_A(self) -> Matrix:
        """φ(A − L₀C)."""
        order = self.A.shape[0]
        columns = [Matrix.unit(order, j) for j in range(order)]
        return Matrix.block([[apply_polynomial(self.factors, self.variable, self.shifted, unit) for unit in columns]])

    @property
    def resultant(self) -> Scalar:
        """Det φ(A − L₀C): the equation has a solution for every G where this does not vanish."""
        return self._at_A.determinant()

    def gain(self, G: Matrix) -> Matrix:
        """Return L = L₀ + (G X⁻¹)ᵀ; raises ZeroDivisionError where X is singular."""
        found = self._at_A @ self.raised(G).T.solve(G.T)
        return (found if self.shift is None else found + self.shift).normal()

    @property
    def is_long(self) -> bool:
        """Whether the general gain is too long to be written out."""
        order, letters = self.A.shape[0], self.A.names | self.C.names
        most = WRITTEN_UP_TO if letters else WRITTEN_OF_NUMBERS
        return comb(len(letters) + len(self.names) + order, order) > most

    def free_entries(self, L: Matrix) -> Matrix | None:
        """Return the G of a member, with w G = e₁ᵀ; None where A − LC is not cyclic from w Lᵀ."""
        own = L if self.shift is None else L - self.shift
        start = Matrix.row(self.weights) @ own.T
        rows, closed = [start], (self.A - L @ self.C).T
        for _ in range(self.A.shape[0] - 1):
            rows.append(rows[-1] @ closed)
        try:
            return (own.T @ Matrix.block([[row] for row in rows]).inverse()).normal()
        except ZeroDivisionError:
            return None


def has_meaning(value: Matrix | None, ideal: Ideal | None) -> bool:
    """Return whether there is a value where an ideal vanishes: whether it divides by nothing that does."""
    return value is not None and (ideal is None or value.common_denominator() not in ideal)


def charts_of(
    A: Matrix,
    C: Matrix,
    factors: tuple[Scalar, ...],
    variable: str,
    names: tuple[str, ...],
    ideal: Ideal | None = None,
) -> list[Sylvester]:
    """Return charts: for each row of G that may be held, then for the sum of all rows and for another combination.

    Every cyclic member lies in the chart of almost every combination.  What lies in `ideal` is 0.
    """
    shift, outputs = parting_shift(A, C, factors, variable), range(C.shape[0])
    if ideal is not None:
        shift = _shift_on(A, C, factors, variable, shift, ideal)
    weights = [tuple(int(i == j) for j in outputs) for i in outputs]
    if len(outputs) > 1:
        weights += [(1,) * len(outputs), tuple(i + 1 for i in outputs)]
    return [Sylvester(A, C, factors, variable, names, shift, w) for w in weights]


def parting_shift(A: Matrix, C: Matrix, factors: Sequence[Scalar], variable: str) -> Matrix | None:
    """Return L₀ with small integers for which A − L₀C has no eigenvalue among the roots of φ; None where A has none.

    One entry after the other: each leaves fewer eigenvalues among the roots.  Of an observable pair there is such an
    entry as long as one is left, since a column of the identity and a row of C move an eigenvalue.
    """
    shift, left = Matrix.zeros(A.shape[0], C.shape[0]), _shared(A, factors, variable)
    if not left:
        return None
    while left:
        for entry in _entries(*shift.shape):
            fewer = _shared(A - (shift + entry) @ C, factors, variable)
            if fewer < left:
                shift, left = shift + entry, fewer
                break
    return shift


def _shift_on(
    A: Matrix, C: Matrix, factors: Sequence[Scalar], variable: str, shift: Matrix | None, ideal: Ideal
) -> Matrix | None:
    """Return a shift for which φ(A − L₀C) is regular where an ideal vanishes: this one, or the first of a few that is."""
    size = A.shape[0] * C.shape[0]
    start = Matrix.zeros(*C.T.shape) if shift is None else shift
    for other in (shift, *(start + entry for entry in islice(_entries(*C.T.shape), 2 * size))):
        chart = Sylvester(A, C, tuple(factors), variable, (), other, ())
        if chart.resultant not in ideal:
            return other
    return shift


def _entries(rows: int, columns: int) -> Iterator[Matrix]:
    """Yield the matrices with a single entry 1, −1, 2, −2, …; some of the first few serve an observable pair."""
    for size in count(1):
        for value in (size, -size):
            for i in range(rows):
                for j in range(columns):
                    yield Matrix.of([[value * int((k, m) == (i, j)) for m in range(columns)] for k in range(rows)])


def _shared(A: Matrix, factors: Sequence[Scalar], variable: str) -> int:
    """Return how many eigenvalues of A, with multiplicity, are roots of φ."""
    rest, found = A.characteristic_polynomial(variable), 0
    for factor in set(factors):
        degree, quotient = factor.degree(variable), rest / factor
        while quotient.denominator.degree(variable) < degree:
            found += degree - quotient.denominator.degree(variable)
            rest = quotient.numerator
            quotient = rest / factor
    return found


# Names: which stand on a page already, and fresh ones.


def taken_names(page: Builder) -> set[str]:
    """Return the names of parameters and coefficients that stand on the page."""
    named = page.environment.coefficients
    inside = {name for meaning in named.values() for name in meaning.field.names}
    return {*page.plant.symbols.signs, *page.plant.field.names, *named, *inside}


def fresh_names(stem: str, count: int, taken: Iterable[str], start: int = 1) -> tuple[str, ...]:
    """Return `stem1`, `stem2`, … (from `start` on) that are not among the names taken."""
    used = set(taken)
    names: list[str] = []
    index = start
    while len(names) < count:
        name = f"{stem}{index}"
        if name not in used:
            names.append(name)
        index += 1
    return tuple(names)
