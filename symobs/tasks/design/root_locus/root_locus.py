"""The root locus of 1 + k C(s)G(s): the roots of p + k q as the gain k grows from 0, its landmarks exact.

p is the denominator of the loop without any cancelling, q its numerator, times −1 where the feedback is positive.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from math import ceil
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import RealNumber, Root, Scalar, roots_of
from symobs.exact.algebraic.root_location import complex_roots
from symobs.exact.algebraic.root_loci import (
    angles_at,
    branch_points,
    coprime,
    crossings,
    crossings_with_letters,
    landmarks,
    leads_negatively,
    omega_digits,
    quotient_at,
    slope_of,
)
from symobs.formula.tree import Decimals, Environment, Roots
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.stability.plots import range_around
from symobs.stability.plots import root_locus as paths_of_roots
from symobs.system.conditions import sign_of
from symobs.system.transfer_function_text import read_transfer_function
from symobs.tasks.analysis.page_parts import factored_form, given
from symobs.tasks.analysis.stability_region.loop_polynomials import Parameters, monic
from symobs.tasks.analysis.stability_region.stability_region import stability_region
from symobs.tasks.analysis.stability_region.stability_region_page import write_line
from symobs.tasks.design.margins.margins import loop_of_controller
from symobs.tasks.result import Result, choose, holds, method, page_of, task

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.formula.figures import PoleMap
    from symobs.proof.certificate.claims import Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import Name, Sign, TransferFunctionText
    from symobs.system.transfer_function_text import WrittenTransferFunction
    from symobs.tasks.analysis.stability_region.stability_region import StabilityRegion


@dataclass
class RootLocus(Result):
    """The roots of p + k q, k ≥ 0."""

    written: WrittenTransferFunction
    sign: int

    task: ClassVar[str] = "root_locus"
    answered_by = ("breakaway", "crossings", "stable_if")
    panels = ("region",)

    def claims(self) -> Iterator[Claim]:
        """Yield what p and q are; the region of stability is claimed by its own task."""
        m, answer, plant = self.plant.matrices, self.answer, self.plant
        below = monic(self.written)[1]
        values: dict[str, Any] = {"A": m.A, "B": m.B, "C": m.C, "D": m.D, "F": self.written.value, "f": below}
        e = Environment(variable=plant.variable, values={**values, "chi_o": answer["p"], "q": answer["q"]})
        yield holds(e, "chi_o = {whole} f", whole=e["A"].pencil.apply("det"))
        yield holds(e, "q I = {sign} chi_o F (C pencil(A)^-1 B + D)", sign=Scalar.of(self.sign))

    @property
    def is_numeric(self) -> bool:
        """Whether the loop has no symbols."""
        return bool((self.answer["p"].names | self.answer["q"].names) <= {self.plant.variable})

    @cached_property
    def region(self) -> StabilityRegion:
        """For which k > 0 the roots are stable."""
        moved = self.answer["p"] + Scalar.symbol("k") * self.answer["q"]
        found: Any = stability_region(moved, symbols=dict(self.plant.symbols.signs), dt=self.plant.dt, parameters="k")
        return found  # type: ignore[no-any-return]

    @property
    def verdict(self) -> str:
        """That of the region of stability tells for which gains; the locus itself always exists."""
        return "yes"

    @property
    def excess(self) -> int:
        """The number of asymptotes."""
        variable = self.plant.variable
        return int(self.answer["p"].degree(variable) - self.answer["q"].degree(variable))

    @cached_property
    def centroid(self) -> Scalar | None:
        """Where the asymptotes meet: (Σ poles − Σ zeros)/(n − m)."""
        if self.excess < 1:
            return None
        sums = [-c[1] / c[0] if len(c) > 1 else Scalar.of(0) for c in map(self._coefficients, ("p", "q"))]
        return (sums[0] - sums[1]) / self.excess

    def _coefficients(self, name: str) -> tuple[Scalar, ...]:
        found: tuple[Scalar, ...] = tuple(self.answer[name].coefficients(self.plant.variable))
        return found

    @cached_property
    def angles(self) -> list[Scalar] | None:
        """The angles of the asymptotes in degrees, None where the sign of the lead of q is open."""
        start = {"positive": 1, "negative": 0}.get(sign_of(self._coefficients("q")[0], self.plant.symbols.signs))
        if start is None:
            return None
        return [Scalar.of(180 * (2 * h + start)) / self.excess for h in range(self.excess)]

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """Poles and zeros, asymptotes, branch points, crossings, angles, and the gains with stability."""
        p, q, variable = self.answer["p"], self.answer["q"], self.plant.variable
        poles, zeros = roots_of(p, variable), roots_of(q, variable)
        found: dict[str, Any] = {"polynomial": p + Scalar.symbol("k") * q, "poles": poles, "zeros": zeros}
        found["asymptotes"] = {"centroid": self.centroid, "angles": self.angles}
        if self.is_numeric:
            above, below = coprime(p, q)
            even = leads_negatively(q, variable)
            found["breakaway"] = [
                {"s": point.s, "k": _exact(point.k), "multiplicity": point.multiplicity}
                for point in branch_points(above, below, variable)
            ]
            found["crossings"] = [
                {
                    "k": _exact(crossing.k),
                    "omega": crossing.omega,
                    "k_decimal": crossing.k.decimal(),
                    "omega_decimal": omega_digits(crossing.x, discrete=variable == "z"),
                }
                for crossing in crossings(above, below, variable)
            ]
            found["departure"] = [_told(angle) for angle in angles_at(poles, zeros, even=even)]
            found["arrival"] = [_told(angle) for angle in angles_at(zeros, poles, even=even)]
        else:
            found |= {"breakaway": self._branch_points, "crossings": self._crossings}
            found |= {"departure": None, "arrival": None}
        found["stable_if"] = self.region.stable_if
        return found

    @property
    def question(self) -> Parameters:
        """What moves."""
        return Parameters(("k",))

    @cached_property
    def picture(self) -> PoleMap | None:
        """The paths from k = 0 to twice the largest gain of a landmark, with the poles and the zeros; None with symbols."""
        p, q, variable, discrete = self.answer["p"], self.answer["q"], self.plant.variable, self.plant.is_discrete
        if not self.is_numeric:
            return None
        gains = [told["k"] for kind in ("branch", "crossing") for told in landmarks(kind, p, q, variable)]
        end = Fraction(ceil(2 * max([Fraction(1), *gains])))
        drawn = paths_of_roots(
            p + Scalar.symbol("k") * q, variable, "k", (Fraction(0), end), None, Fraction(1) if discrete else None
        )
        if drawn is None:
            return None
        zeros = tuple(complex_roots([c.fraction() for c in q.coefficients(variable)])) if q.degree(variable) > 0 else ()
        places = [place for path in (*drawn.paths, zeros) for place in path]
        window = range_around([x for x, _ in places], spread=True), range_around([y for _, y in places], spread=True)
        return replace(drawn, zeros=zeros, window=window)

    @property
    def _crossings(self) -> list[dict[str, Any]] | None:
        """The crossings of the imaginary axis with symbols, where ω² is rational in them and neither ω² nor k surely ≤ 0."""
        if self.plant.is_discrete:
            return None
        signs, never = self.plant.symbols.signs, {"negative", "nonpositive", "zero"}
        listed = crossings_with_letters(*coprime(self.answer["p"], self.answer["q"]))
        return [
            {"k": k, "omega": f"sqrt({x})"} for k, x in listed if not {sign_of(k, signs), sign_of(x, signs)} & never
        ]

    @cached_property
    def _branch_points(self) -> list[dict[str, Any]]:
        """The multiple roots with symbols of degree 1 and 2, each with its k: on the locus where that is not negative."""
        p, q, variable = self.answer["p"], self.answer["q"], self.plant.variable
        found: list[dict[str, Any]] = []
        for root in dict.fromkeys(roots_of(slope_of(p, q, variable), variable)):
            if root.factor.degree(variable) == 1 and not q.substitute({variable: root.centre}).is_zero:
                place = {variable: root.centre}
                found.append({"s": root.centre, "k": -p.substitute(place) / q.substitute(place)})
            elif root.is_closed and root.factor.degree(variable) == 2:
                rational, part = quotient_at(p, q, root.factor, variable)
                k = f"{-(rational + part * root.centre)} + ({-part * root.sign})*sqrt({root.radicand})"
                found.append({"s": root, "k": k})
        return found


def _exact(number: RealNumber) -> Any:
    """Return a number in closed form, else as a root of its polynomial."""
    closed = number.closed_form()
    return closed if closed is not None else number.text("k")


def _told(angle: Any) -> dict[str, Any]:
    return {"s": angle.s, "angle": angle.degrees}


@method("root_locus/rules", source="ogata2010, ch. 6")
def by_rules(plant: StateSpace, written: WrittenTransferFunction, sign: int) -> RootLocus:
    """Find the landmarks of p + k q by the rules: multiple roots, roots on the boundary, angles."""
    closed, opened = loop_of_controller(plant, written, proper=True)
    moved = (closed - opened) * sign
    if moved.is_zero:
        message = "the loop has the transfer function 0, so no root moves"
        raise InputError(
            message, where="specification.controller", repair="give a plant and a controller that are not 0"
        )
    return RootLocus(plant, "rules", {"p": opened, "q": moved}, written, sign)


@task
def root_locus(
    plant: StateSpace, *, controller: TransferFunctionText = None, gain_sign: Sign = 1, method: Name = "auto"
) -> Result:
    """Return the root locus of 1 + k C(s)G(s): the roots of p + k q for k from 0, with landmarks that are exact.

    plant       n states, one input and one output; with symbols what stays exact
    controller  C(s), a rational function, 1 where it is left out
    gain_sign   1, or −1 for 1 − k C(s)G(s), k > 0 all the same
    Returns poles (k = 0) and zeros; asymptotes (centroid, angles in degrees); breakaway: s, k of multiple roots, one of a
    conjugate pair; crossings: k and omega of roots on the imaginary axis, in discrete time the angle on the unit circle;
    departure and arrival: s, angle in degrees at complex poles and zeros; stable_if.
    Raises `InputError` for several inputs or outputs, a loop that is not proper, and a symbol k in the data.
    Source: K. Ogata, Modern Control Engineering, 5th ed., ch. 6.
    """
    plant.require("B", "C", task="root_locus")
    if (plant.inputs, plant.outputs) != (1, 1):
        message = f"a root locus has one gain, and the plant has {plant.inputs} inputs and {plant.outputs} outputs"
        raise InputError(
            message, where="plant", repair="give a plant with one of each, such as one input and one output of it"
        )
    if controller is not None:
        plant = plant.knowing(controller)
    if gain_sign not in (1, -1):
        raise InputError(f"gain_sign is {gain_sign}", where="specification.gain_sign", repair="write 1 or -1")
    plant = plant.in_digits()
    given_controller = "1" if controller is None else controller
    written = read_transfer_function(given_controller, plant.symbols, plant.variable, "specification.controller")
    if "k" in {*plant.field.names, *written.value.names}:
        message = "k is the gain of the root locus, and it stands in the data"
        raise InputError(message, where="symbols.k", repair="give the parameter another name")
    signs = {**plant.symbols.signs, "k": "positive"}
    plant = plant.with_symbols(replace(plant.symbols, signs=signs))
    found: Any = choose("root_locus", method, "rules").solve(plant, written, int(gain_sign))
    found.region  # noqa: B018 - what it cannot be found for is refused here, not by the page
    return found.asked(method)  # type: ignore[no-any-return]


# The page: the rules in the order of a textbook, each with its number.


@page_of(RootLocus)
def write_root_locus(page: Builder, result: RootLocus) -> None:
    """Write the whole page."""
    given(page)
    with page.section("root_locus"):
        _polynomials(page, result)
        _ends(page, result)
        if result.is_numeric:
            for kind in ("branch", "departure", "arrival", "crossing"):
                _landmarks(page, result, kind)
        page.remark("locus_stability")
        write_line(page, result.region, "chi_p", with_pictures=False)
        if result.picture is not None:
            page.plot(result.picture, page["chi_p"])


def _polynomials(page: Builder, result: RootLocus) -> None:
    """Write p, q and p + k q."""
    plant, written, k = page.plant, result.written, page.value(Scalar.symbol("k"))
    if written.value.is_one:
        page.remark("locus_gain")
    else:
        page.define("F", factored_form(page, written.value), say="locus_controller", closing=False)
    opened, below = page["det(pencil(A))"], monic(written)[1]
    opened = opened if below.is_one else opened @ page.value(below)
    page.define("chi_o", opened, page.value(result.answer["p"]), say="locus_poles", closing=False)
    response = page["C pencil(A)^-1 B"]
    response = response + page["D"] if plant.matrices.has_feedthrough else response
    loop = page("chi_o F {response}" if page.defines("F") else "chi_o {response}", response=response)
    page.define(
        "q", loop if result.sign > 0 else -loop, page.value(result.answer["q"]), say="locus_zeros", closing=False
    )
    moved = page("chi_o + {k} q", k=k)
    page.define("chi_p", moved, page.value(result.region.answer["polynomial"]), say="locus_moved", closing=False)


def _ends(page: Builder, result: RootLocus) -> None:
    """Write where branches begin and end, and the asymptotes."""
    for name, letter, key in (("poles", "chi_o", "locus_begin"), ("zeros", "q", "locus_end")):
        roots: tuple[Root, ...] = result.fields[name]
        if roots and all(root.is_closed for root in roots):
            lead = result.answer["p" if letter == "chi_o" else "q"].coefficients(page.plant.variable)[0]
            of = page[letter] if lead.is_one else page[letter] / page.value(lead)
            page.remark(key, roots=Roots(of.formula, roots))
    lead = sign_of(result.answer["q"].coefficients(page.plant.variable)[0], page.plant.symbols.signs)
    if lead in {"positive", "negative"}:
        page.remark("locus_axis_odd" if lead == "positive" else "locus_axis_even")
    if result.centroid is not None:
        page.remark("locus_asymptotes", excess=str(result.excess), centroid=page.value(result.centroid))


def _landmarks(page: Builder, result: RootLocus, kind: str) -> None:
    """Write each landmark of a kind by its digits."""
    for told in landmarks(kind, result.answer["p"], result.answer["q"], page.plant.variable):
        slots = {name: page.term(Decimals(Scalar.of(value))) for name, value in told.items()}
        pair = "_pair" if kind == "branch" and "imaginary" in told else ""
        circle = "_discrete" if kind == "crossing" and page.plant.is_discrete else ""
        page.remark(f"locus_{kind}{pair}{circle}", **slots)
