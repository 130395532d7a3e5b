"""The reduced-order observer  ż = F z + G u + H y,  x̂ = M [y − D u; z].

In the coordinates T = [C; R], x₁ = C x is measured and x₂ = R x is not.  With P = R − L C the estimate of P x is z.
"""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

from symobs.exact import Ideal, Matrix, Root, Scalar, kernel, modulo, unit_rows
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.formula.tree import Environment
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError
from symobs.system import StateSpace
from symobs.system.conditions import joined
from symobs.system.specification import (
    DesiredPolynomial,
    MatrixText,
    Name,
    Poles,
    PolynomialText,
    desired_polynomial,
    in_common_field,
    read_gain,
)
from symobs.tasks.analysis.strata.strata import equations_of, places, solved
from symobs.tasks.design.full_order.observer import ObserverDesign
from symobs.tasks.design.gain.gain_cases import chosen, design_of, places_beside
from symobs.tasks.design.gain.gain_design import letters_of
from symobs.tasks.result import Case, Result, equality, holds, method, poles_of, task
from symobs.tasks.result import choose as choose_method
from symobs.tasks.result.control_systems import Controller, observer_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.proof.certificate.claims import Certificate, Claim
    from symobs.system.conditions import Condition
    from symobs.tasks.analysis.strata.strata import Place


# The coordinates of a reduced-order observer: the outputs first, rows that complete them after.


class Partition(NamedTuple):
    """The plant in the coordinates x̄ = T x, the measured states first."""

    T: Matrix
    A11: Matrix
    A12: Matrix
    A21: Matrix
    A22: Matrix
    B1: Matrix | None
    B2: Matrix | None


def partition(plant: StateSpace, T: Matrix) -> Partition:
    """Return T A T⁻¹ and T B in blocks; raises ZeroDivisionError where T is singular."""
    m, measured = plant.matrices, plant.outputs
    first, second = range(measured), range(measured, plant.order)
    A = (T @ m.A @ T.inverse()).normal()
    B = (T @ m.B).normal() if m.has_input else None
    A11, A12, A21, A22 = (A.select(rows, columns) for rows in (first, second) for columns in (first, second))
    B1, B2 = (
        (None, None) if B is None else (B.select(first, range(plant.inputs)), B.select(second, range(plant.inputs)))
    )
    return Partition(T, A11, A12, A21, A22, B1, B2)


def completed(C: Matrix, ideal: Ideal | None = None) -> Matrix:
    """Return T = [C; R], R the unit rows of the columns without a pivot; constant pivots are preferred.

    What lies in `ideal` is 0.  Raises `InputError` where the rows of C depend on each other.
    """
    pivots = _pivots(C, ideal)
    if len(pivots) < C.shape[0]:
        message = "the rows of C depend on each other: one output is a combination of the others"
        raise InputError(message, where="plant.C", repair="leave that output out")
    others = tuple(j for j in range(C.shape[1]) if j not in pivots)
    return Matrix.block([[C], [unit_rows(C.shape[1], others)]]) if others else C


def _coordinates(plant: StateSpace) -> Matrix:
    """Return [C; R]; at values of parameters with the R of the plant that has them, where it serves."""
    C, general = plant.matrices.C, plant.general
    if general is not None and len(pivots := _pivots(general.matrices.C, None)) == C.shape[0]:
        others = tuple(j for j in range(C.shape[1]) if j not in pivots)
        T = Matrix.block([[C], [unit_rows(C.shape[1], others)]])
        if not T.determinant().is_zero:
            return T
    return completed(C, plant.ideal)


def _pivots(C: Matrix, ideal: Ideal | None) -> list[int]:
    """Return the pivot columns of C, row by row: the first with a constant entry, else the first with an entry."""
    rows = [list(row) for row in C.rows]
    found: list[int] = []
    for index, row in enumerate(rows):
        candidates = [j for j, entry in enumerate(row) if not entry.is_zero and (ideal is None or entry not in ideal)]
        if not candidates:
            continue
        pivot = next((j for j in candidates if row[j].is_constant), candidates[0])
        found.append(pivot)
        for other in rows[index + 1 :]:
            factor = other[pivot] / row[pivot]
            other[:] = [a - factor * b for a, b in zip(other, row, strict=True)]
    return found


@dataclass
class ReducedOrderObserver(Result):
    """An observer of order n − p: P A − F P = H C, G = P B − H D, M [C; P] = I, det(sI − F) = φ(s), P = R − L C.

    `inner` is the gain L for the pair (A₁₂, A₂₂), with its own claims.
    """

    desired: DesiredPolynomial
    inner: ObserverDesign

    task: ClassVar[str] = "reduced_order_observer"
    answered_by = ("F", "G", "H", "M")
    gains = ("L",)
    in_coordinates = ("F", "G", "H", "M")
    letters = {
        "L": "L",
        "F": "F_z",
        "G": "G_z",
        "H": "H_z",
        "M": "M_z",
        "T": "T",
        "polynomial": "phi",
        "poles": "phi",
    }
    panels = ("plane", "responses")
    cards = ("L", "F", "G", "H", "M", "polynomial")
    letter: ClassVar[str] = "L"

    @classmethod
    def of(cls, plant: StateSpace, desired: DesiredPolynomial, T: Matrix, method_name: str) -> Self:
        """Return the observer in the coordinates T, or the negative result."""

        def find() -> ReducedOrderObserver:
            inner = design_of(ObserverDesign, _unmeasured(plant, partition(plant, T)), desired)
            return cls.assembled(plant, inner, desired, T, method_name)

        found: Self = plant.once((cls, desired, T, method_name), find)
        return found

    @classmethod
    def assembled(
        cls, plant: StateSpace, inner: ObserverDesign, desired: DesiredPolynomial, T: Matrix, method_name: str
    ) -> Self:
        """Return the observer with a gain for (A₁₂, A₂₂)."""
        parts = partition(plant, T)
        m = plant.matrices
        answer: dict[str, Any] = dict.fromkeys("LTFGHM") | {"T": T}
        L = inner.answer["L"]
        if L is not None:
            F = (parts.A22 - L @ parts.A12).normal()
            H = (F @ L + parts.A21 - L @ parts.A11).normal()
            G = None
            if parts.B1 is not None and parts.B2 is not None:
                G = parts.B2 - L @ parts.B1
                G = (G - H @ m.D if m.has_feedthrough else G).normal()
            known, rest = Matrix.identity(plant.outputs), Matrix.identity(L.shape[0])
            lift = Matrix.block([[known, Matrix.zeros(plant.outputs, L.shape[0])], [L, rest]])
            answer |= {"L": L, "F": F, "G": G, "H": H, "M": (T.inverse() @ lift).normal()}
        return cls(plant, method_name, answer, desired, inner)

    def with_answer(self, name: str, value: object) -> Self:
        """Return the observer with another L, and with the F, G, H and M that follow from it."""
        if name != "L":
            return super().with_answer(name, value)
        inner = self.inner.with_answer("L", value)
        remade = type(self).assembled(self.plant, inner, self.desired, self.answer["T"], self.method)
        return remade.in_place_of(self)

    def following_from(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the observer of a given L."""
        if "L" not in gains:
            return self
        inner = ObserverDesign.of_given(self.inner.plant, gains["L"])
        placed = DesiredPolynomial(self.plant.variable, (inner.answer["polynomial"],))
        return self.assembled(self.plant, inner, placed, self.answer["T"], self.method)

    def design_of(self, gain: str) -> ObserverDesign:  # noqa: ARG002 - it has one
        """Return the gain of the pair (A₁₂, A₂₂)."""
        return self.inner

    @property
    def has_reduced_observer(self) -> bool:
        """It is one."""
        return True

    def claims(self) -> Iterator[Claim]:
        """Yield that z follows P x, that [C; P] is undone by M, and where the poles are."""
        plant, answer = self.plant, self.answer
        rows, columns = range(plant.outputs), range(plant.order)
        values = letters_of(plant) | {name: value for name, value in answer.items() if value is not None}
        T: Matrix = answer["T"]
        values |= {"phi": self.desired.polynomial, "R": T.select(range(plant.outputs, plant.order), columns)}
        e = Environment(variable=plant.variable, values=values)
        parts, inner = partition(plant, T), self.inner
        yield holds(e, "{columns} = C", "the upper rows of T are C", columns=T.select(rows, columns))
        yield equality(parts.A22, inner.plant.matrices.A, e, "the inner gain is one for A22")
        yield equality(parts.A12, inner.plant.matrices.C, e, "the inner gain is one for A12")
        yield holds(e, "phi = {polynomial}", "the inner gain is one for phi(s)", polynomial=inner.answer["polynomial"])
        if (answer["L"] is None) != (inner.answer["L"] is None):
            raise CertificateRejected("there is a reduced-order observer exactly where the pair (A12, A22) has a gain")
        if answer["L"] is None:
            return
        if (answer["G"] is None) == plant.matrices.has_input:
            raise CertificateRejected("G belongs to a plant with an input, and to no other")
        C, L, H, R = (e[name] for name in "CLHR")
        P = R - L @ C
        yield holds(e, "(R - L C) A - F (R - L C) = H C")
        if answer["G"] is not None:
            driven = P @ e["B"]
            if plant.matrices.has_feedthrough:
                driven = driven - H @ e["D"]
            yield holds(e, "G = {driven}", driven=driven)
        yield holds(e, "M [C; R - L C] = I")
        yield holds(e, "det(pencil(F)) = phi")

    @property
    def systems(self) -> Mapping[str, Realisation]:
        """The plant, and the observer (u, y) → x̂ with the state z."""
        m, known = self.plant.matrices, self.answer
        if known["L"] is None:
            return super().systems
        M = known["M"]
        rows, p = range(self.plant.order), self.plant.outputs
        of_y, of_z = M.select(rows, range(p)), M.select(rows, range(p, self.plant.order))
        driven, shown = known["H"], of_y
        if m.has_input:
            driven, shown = Matrix.block([[known["G"], driven]]), Matrix.block([[-(of_y @ m.D), shown]])
        return {**super().systems, "observer": Realisation(known["F"], driven.normal(), of_z, shown.normal())}

    @property
    def controller(self) -> Controller | None:
        """(u, y) → x̂."""
        return observer_of(self)

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of the inner gain and of the observer."""
        return (*self.inner.certificates, *self.certificates)

    @property
    def free_signals(self) -> Mapping[str, int]:
        """The estimate of x₂; the observer's state where the estimate is made of it."""
        names = ["x_2_hat"]
        if self.page_method == "undetermined":
            names.append("w_o" if self.plant.is_discrete else "z_o")
        return dict.fromkeys(names, self.plant.order - self.plant.outputs)

    @property
    def verdict(self) -> str:
        """`no` where φ cannot be assigned."""
        return "no" if self.answer["L"] is None else super().verdict

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The conditions of the coordinates and of the inner gain."""
        return joined(super().holds_where, (c for c in self.inner.holds_where if c.kind == "existence"))

    @property
    def unmoved_modes(self) -> tuple[Root, ...]:
        """The modes that no gain moves."""
        return self.inner.unmoved_modes

    @property
    def gain_family(self) -> dict[str, Any] | None:
        """The general gain L where it is not unique."""
        return self.inner.gain_family

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The whole question again where T is singular or the pair (A₁₂, A₂₂) loses its rank."""

        def solve(plant: StateSpace, values: dict[str, Scalar]) -> Result:
            wanted = self.desired.substitute(values), self.answer["T"].substitute(values)
            there, (desired, T) = in_common_field(plant, *wanted)
            return reduced_observer_of(there, desired, T, self.method)

        return solved(self.plant, self.places, solve)

    @cached_property
    def places(self) -> tuple[Place, ...]:
        """The strata where T is singular or the pair (A₁₂, A₂₂) loses its rank, each of them once."""
        determinant = self.answer["T"].determinant()
        own = places(self.plant, (determinant, *self.inner.existence, *chosen(self.inner)))
        if self.plant.outputs == 1 and not self.unmoved_modes:
            return own
        found = {equations_of(place): place for place in own}
        for place in places_beside(self, self.inner):
            found.setdefault(equations_of(place), place)
        return tuple(found.values())

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The fields of the contract, and P, polynomial and family."""
        return {
            **{name: self.answer[name] for name in "LTFGHM"},
            "polynomial": self.desired.polynomial,
            "poles": self.inner.roots if self.answer["L"] is not None else (),
            "fixed_modes": self.unmoved_modes,
            "family": None if self.gain_family is None else self.inner.reported_family,
        }


@dataclass
class DependentOutputs(ReducedOrderObserver):
    """No observer of order n − p on a stratum: w C = 0 with w ≠ 0, so no [C; P] with n rows has an inverse."""

    #: There are no coordinates [C; R], and no pair (A₁₂, A₂₂) in them.
    inner: ObserverDesign = field(default=None, init=False)  # type: ignore[assignment]

    def claims(self) -> Iterator[Claim]:
        """Yield w C = 0 and w ≠ 0."""
        e = Environment(values=letters_of(self.plant) | {"w": self.answer["w"]})
        yield holds(e, "w C = 0")
        yield holds(e, "w !== 0")
        if any(self.answer[name] is not None for name in "LTFGHM"):
            raise CertificateRejected("outputs that depend on each other leave no observer of order n - p")

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates that outputs depend on each other."""
        return self.certificates

    @property
    def holds_where(self) -> tuple[Condition, ...]:
        """Everywhere on the stratum: the rank of C is nowhere higher there."""
        return self.domain

    @property
    def unmoved_modes(self) -> tuple[Root, ...]:
        """None that is spoken of."""
        return ()

    @property
    def gain_family(self) -> None:
        """None: there is no gain."""

    @property
    def places(self) -> tuple[Place, ...]:
        """None: nothing else is true anywhere on the stratum."""
        return ()


def reduced_observer_of(
    plant: StateSpace, desired: DesiredPolynomial, T: Matrix | None = None, method_name: str = "partition"
) -> ReducedOrderObserver:
    """Return the observer in the coordinates T, or in others where these are singular; the negative result where a case is.

    Raises `InputError` where the outputs of a plant depend on each other that is neither a stratum nor at values.
    """
    C = plant.matrices.C
    if (plant.is_stratum or plant.general) and (rows := kernel(C.T, plant.ideal)).shape[1]:
        w = modulo(rows.select(range(rows.shape[0]), [0]).T, plant.ideal)
        return DependentOutputs(plant, method_name, dict.fromkeys("LTFGHM") | {"w": w}, desired)
    usable = T is not None and not plant.simplified(T.determinant()).is_zero
    return ReducedOrderObserver.of(plant, desired, T if T is not None and usable else _coordinates(plant), method_name)


def _unmeasured(plant: StateSpace, parts: Partition) -> StateSpace:
    """Return the plant of x₂ alone, seen through A₁₂."""
    seen = StateSpace(parts.A22, None, parts.A12, dt=plant.dt, symbols=plant.symbols)
    return plant.beside(seen.restricted(plant.equations, plant.nonzero))


@method("reduced_order_observer/partition", source="luenberger1971; gopinath1971")
def by_partition(plant: StateSpace, desired: DesiredPolynomial, T: Matrix) -> ReducedOrderObserver:
    """L places the poles of A₂₂ − L A₁₂ in coordinates where the outputs are the first states."""
    return ReducedOrderObserver.of(plant, desired, T, "partition")


@method("reduced_order_observer/undetermined", source="luenberger1971")
def undetermined(plant: StateSpace, desired: DesiredPolynomial, T: Matrix) -> ReducedOrderObserver:
    """x̂₂ = z + L x₁, ż = F z + G u + H y: the error is free of x and u for one choice of F, G, H, whatever L is."""
    return ReducedOrderObserver.of(plant, desired, T, "undetermined")


def unmeasured(plant: StateSpace, _: object = None) -> int:
    """Return the number of states that are left to estimate, n − p."""
    return plant.order - plant.outputs


@task
@poles_of(poles=unmeasured)
def reduced_order_observer(
    plant: StateSpace,
    *,
    poles: Poles = None,
    polynomial: PolynomialText = None,
    T: MatrixText = None,
    choose: Name = "auto",
    method: Name = "auto",
) -> Result:
    """Design the observer of order n − p  ż = F z + G u + H y,  x̂ = M [y − D u; z],  with det(sI − F) = φ(s).

    plant         n states, p < n outputs, none a combination of the others; B may be missing
    poles         n − p desired poles, closed under conjugation; or
    polynomial    φ, monic of degree n − p
    choose        which gain of several outputs: "simple" or "small", as for `observer`
    T             optional n×n coordinates x̄ = T x whose upper p rows are C
    Returns L ((n−p)×p), T, F, G, H, M; where (C, A) is not observable either the family of gains or verdict `no` with
    the fixed modes.  Raises `InputError` for wrong poles or shapes, and where nothing is left to estimate.
    Source: D. G. Luenberger (1971); B. Gopinath (1971).
    """
    plant = plant.knowing(poles, polynomial, T)
    plant.require("C", task="reduced_order_observer")
    if plant.order == plant.outputs:
        completed(plant.matrices.C)  # raises where C is singular
        message = "the outputs show the whole state, nothing is left to estimate"
        raise InputError(message, where="plant.C", repair="use x = C⁻¹ (y − D u)")
    desired = desired_polynomial(plant, poles, polynomial, degree=unmeasured(plant), choose=choose)
    assert desired is not None  # noqa: S101 - required
    plant, (desired,) = in_common_field(plant, desired)
    if plant.general and len(_pivots(plant.matrices.C, None)) < plant.outputs:
        return reduced_observer_of(plant, desired).asked(method)
    coordinates = _coordinates(plant) if T is None else _read_coordinates(T, plant)
    return choose_method("reduced_order_observer", method, "partition").solve(plant, desired, coordinates).asked(method)


def _read_coordinates(value: object, plant: StateSpace) -> Matrix:
    T = read_gain(value, plant, "T", (plant.order, plant.order))
    if T.select(range(plant.outputs), range(plant.order)) != plant.matrices.C:
        raise InputError("the upper rows of T are not C", where="specification.T", repair="write T as [C; R]")
    if T.determinant().is_zero:
        message = "T is singular"
        raise InputError(message, where="specification.T", repair="choose rows below C that are independent of it")
    return T
