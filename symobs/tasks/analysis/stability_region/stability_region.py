"""For which parameters are all roots stable: conditions, exact intervals, the exact decomposition of the plane."""

from __future__ import annotations

from dataclasses import replace
from difflib import get_close_matches
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import Scalar
from symobs.exact.core.generators import function_named
from symobs.formula.tree import Environment
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import BudgetExceeded, InputError
from symobs.proof.certificate.claims import Claim, Statement
from symobs.stability.criteria.critical_polynomials import CriticalPolynomials, StabilityBoundary
from symobs.stability.criteria.routh_table import RouthTable, is_routh_table, routh_table
from symobs.stability.criteria.stability_conditions import is_stable_where, stable_where
from symobs.stability.inequalities.decision import SignCase, sign_cases
from symobs.stability.inequalities.proof import asks_z3
from symobs.stability.inequalities.simplify import as_inequality, box, root_of_square
from symobs.stability.plots import oriented, picture_of_line, picture_of_plane, picture_with_symbols, pole_map
from symobs.stability.regions.description import are_whole, parts
from symobs.stability.regions.region import LineRegion, PlaneRegion, RegionInequality, exact_region, short_list
from symobs.stability.regions.region_check import are_parts, is_region
from symobs.system import StateSpace, Symbols, read_scalar
from symobs.system.conditions import Condition, sign_of
from symobs.system.specification import read_gain, read_names, reject_both
from symobs.system.transfer_function_text import read_transfer_function
from symobs.tasks.analysis.stability_region.loop_polynomials import loop_polynomials, monic
from symobs.tasks.result import Case, Result, choose, holds, method, task

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from fractions import Fraction

    from symobs.exact import Matrix, RealNumber
    from symobs.formula.figures import Picture, PoleMap
    from symobs.stability.inequalities.proof import Equivalence
    from symobs.stability.inequalities.simplify import Simplified
    from symobs.stability.regions.description import CylindricalPart, Edge
    from symobs.stability.regions.region import IntervalPiece
    from symobs.system.specification import GainText, Name, Names, PolynomialText, Quantity, TransferFunctionText
    from symobs.system.transfer_function_text import WrittenTransferFunction


# The fields of a stability region: exact texts, decimals beside.


DIGITS = 6


def stable_if(
    bounds: Sequence[RegionInequality] | None, region: object, signs: Mapping[str, str], parameters: Sequence[str]
) -> list[str]:
    """Return the inequalities as texts; of a single interval its ends."""
    if bounds is None:
        return ["False"]
    if isinstance(region, LineRegion) and len(region.intervals) == 1 and not region.cuts:
        return ends_of(region.intervals[0], region.name, signs)
    return [" ".join(map(str, solved(bound, signs, parameters))) for bound in bounds]


def solved(bound: RegionInequality, signs: Mapping[str, str], parameters: Sequence[str] = ()) -> tuple[Any, str, Any]:
    """Return an inequality solved for a parameter where its coefficient has a certain sign."""
    if bound.operator == "!=":
        left, operator, right = as_inequality(bound.polynomial, signs, parameters)
        return left, "!=" if operator else operator, right
    return as_inequality(bound.polynomial, signs, parameters)


def of_conditions(found: Simplified, question: RegionQuestion) -> dict[str, Any]:
    """Return the fields of a region given by inequalities alone: empty, bounded, a sample point."""
    empty = True if found.verdict == "no" else False if found.point is not None or found.verdict == "yes" else None
    limits = box(found.positive, question.parameters, question.plant.symbols.signs) if found.verdict != "no" else None
    fields: dict[str, Any] = {"empty": empty, "irredundant": found.irredundant, "bounded": None}
    if limits is not None and not limits.needs:
        fields["bounded"] = limits.bounded
        fields["components"] = [{"bounded": limits.bounded, "sample": _texts(limits.sample)}]
    point = limits.sample if limits is not None and limits.sample else found.point
    fields["sample_points"] = [_texts(point)] if point else []
    return fields


def _texts(point: Mapping[str, Any] | None) -> dict[str, str]:
    return {name: str(value) for name, value in (point or {}).items()}


def ends_of(piece: IntervalPiece, name: str, signs: Mapping[str, str]) -> list[str]:
    """Return name > low and name < high, without bounds implied by the declared sign."""
    found = []
    if piece.low is not None and not (
        signs.get(name) == "positive" and piece.low.is_rational and not piece.low.fraction
    ):
        found.append(f"{name} > {piece.low.text(name)}")
    if piece.high is not None and not (
        signs.get(name) == "negative" and piece.high.is_rational and not piece.high.fraction
    ):
        found.append(f"{name} < {piece.high.text(name)}")
    return found


def end(number: RealNumber | None, side: str, name: str = "x") -> str:
    """Return an end of an interval as an exact text."""
    return f"{side}oo".lstrip("+") if number is None else number.text(name)


def decimals(number: RealNumber | None, side: str) -> str:
    """Return an end of an interval as a decimal, rounded."""
    return f"{side}oo".lstrip("+") if number is None else number.decimal(DIGITS)


def intervals_of(region: LineRegion) -> dict[str, Any]:
    """Return the open intervals, exact and in decimals, the points left out between them, and a point of each."""
    name, pieces = region.name, region.intervals
    return {
        "bounded": region.bounded,
        "intervals": [[end(p.low, "-", name), end(p.high, "+", name)] for p in pieces],
        "intervals_decimal": [[decimals(p.low, "-"), decimals(p.high, "+")] for p in pieces],
        "excluded_points": [{name: point.text(name)} for point in region.cuts],
        "sample_points": [{name: str(piece.sample)} for piece in pieces],
    }


def _edge(edge: Edge | None, side: str, name: str) -> str:
    """Return a bound as an exact text: in closed form, or as a root of its polynomial in `name`."""
    if edge is None:
        return f"{side}oo".lstrip("+")
    return str(edge.closed) if edge.closed is not None else f"CRootOf({edge.polynomial}, {name}, {edge.number})"


def _point(region: PlaneRegion, sample: tuple[Fraction, Fraction]) -> dict[str, str]:
    return {name: str(value) for name, value in zip(region.names, sample, strict=True)}


def cells_of(region: PlaneRegion) -> list[dict[str, Any]]:
    """Return every open cell: its bounds, a point of it, whether it is stable, and its component."""
    from symobs.stability.regions.description import edges_over  # noqa: PLC0415 - only where cells are asked for

    component = {cell: k for k, found in enumerate(region.components) for cell in found.cells}
    x, y = region.names
    widths = [[end(cylinder.left, "-", x), end(cylinder.right, "+", x)] for cylinder in region.plane.cylinders]
    heights = [
        [_edge(None, "-", y), *(_edge(edge, "", y) for edge in edges_over(region, index)), _edge(None, "+", y)]
        for index in range(len(widths))
    ]
    return [
        {
            "sample": _point(region, cell.sample),
            "stable": cell.stable,
            "component": component.get(number),
            x: list(widths[cell.cylinder]),
            y: heights[cell.cylinder][cell.height : cell.height + 2],
        }
        for number, cell in enumerate(region.cells)
        if cell.allowed
    ]


def components_of(region: PlaneRegion, parts: Sequence[CylindricalPart]) -> list[dict[str, Any]]:
    """Return every connected component: bounded or not, a point of it, and bounds of y over intervals of x."""
    x, y = region.names
    listed = []
    for number, component in enumerate(region.components):
        own = [part for part in parts if part.component == number]
        listed.append(
            {
                "bounded": component.bounded,
                "sample": _point(region, region.cells[component.cells[0]].sample),
                "parts_are_whole": are_whole(region, parts),
                "parts": [
                    {
                        x: [end(part.low, "-", x), end(part.high, "+", x)],
                        y: [_edge(part.lower, "-", y), _edge(part.upper, "+", y)],
                        "closed": [part.begins, part.reaches],
                    }
                    for part in own
                ],
            }
        )
    return listed


def excluded_of(region: PlaneRegion) -> dict[str, Any]:
    """Return isolated points and curves that the region surrounds without containing them, and a point of each component."""
    x, y = region.names
    points = [
        {x: hole.x.text(x), y: hole.y.text(y) if hole.y is not None else f"about {float(hole.near[1]):.6g}"}
        for hole in region.holes
    ]
    samples = [_point(region, region.cells[component.cells[0]].sample) for component in region.components]
    curves = [f"{factor} == 0" for factor in region.surrounded()]
    return {"excluded_points": points, "excluded_curves": curves, "sample_points": samples}


# The polynomial of a stability region: given, or that of a plant whose gain has free entries.


#: The determinants that decide for a polynomial with parameters grow too large beyond this degree.
MOST_DEGREE = 40


@dataclass
class RegionQuestion:
    """The polynomial's origin (gains that are given, else the plant itself), the parameters, and what stable means."""

    plant: StateSpace
    K: Matrix | None
    L: Matrix | None
    parameters: tuple[str, ...]
    boundary: StabilityBoundary
    controller: WrittenTransferFunction | None = None

    @cached_property
    def polynomial(self) -> Scalar:
        """χ: the polynomial itself, or det(sI − A), det(sI − A + BK), det(sI − A + LC), or the product of the last two.

        With a controller F it is the numerator of 1 + F(s)G(s), without any cancelling.
        """
        m, variable = self.plant.matrices, self.plant.variable
        if self.plant.polynomial is not None:
            return self.plant.polynomial
        if self.controller is not None:
            opened, added = loop_polynomials(self.plant, self.controller)
            return opened + added
        moved = [m.A - m.B @ self.K] if self.K is not None else []
        moved += [m.A - self.L @ m.C] if self.L is not None else []
        found = Scalar.of(1)
        for matrix in moved or [m.A]:
            found = found * matrix.characteristic_polynomial(variable)
        return found

    @property
    def limits(self) -> dict[str, Any]:
        """The boundary as keywords."""
        margin, radius = self.boundary.margin, self.boundary.radius
        discrete = self.boundary.discrete
        return {
            "discrete": discrete,
            "margin": None if margin.is_zero else margin,
            "radius": None if radius.is_one else radius,
        }

    @cached_property
    def critical(self) -> CriticalPolynomials:
        """Where roots can cross the boundary."""
        return CriticalPolynomials(self.polynomial, self.boundary, self.plant.symbols.signs)

    @property
    def symbols(self) -> tuple[str, ...]:
        """The names in the polynomial that are no parameters."""
        own = (self.polynomial.names | self.boundary.names) - {self.boundary.variable}
        return tuple(sorted(own - set(self.parameters)))


def read_question(
    plant: StateSpace,
    gains: dict[str, object],
    parameters: object,
    margin: object,
    radius: object,
    controller: object = None,
) -> RegionQuestion:
    """Return the question; raises `InputError` where its parts do not fit together."""
    loop = _read_controller(plant := plant.knowing(controller), controller, gains) if controller is not None else None
    if plant.polynomial is not None and any(gain is not None for gain in gains.values()):
        name = next(name for name, gain in gains.items() if gain is not None)
        message = f"both a polynomial and the gain {name} are given"
        raise InputError(
            message, where=f"specification.{name}", repair="keep one of them; a gain needs a plant A, B, C"
        )
    plant = plant.knowing(*gains.values())
    found: dict[str, Matrix | None] = dict.fromkeys(gains)
    if gains["K"] is not None:
        plant.require("B", task="the gain K")
        found["K"] = read_gain(gains["K"], plant, "K", (plant.inputs, plant.order))
    if gains["L"] is not None:
        plant.require("C", task="the gain L")
        found["L"] = read_gain(gains["L"], plant, "L", (plant.order, plant.outputs))
    boundary = _boundary(plant, margin, radius)
    asked = RegionQuestion(plant, found["K"], found["L"], (), boundary, loop)
    roots = (asked.polynomial.field | boundary.margin.field | boundary.radius.field).numbers.names
    if roots:
        message = f"the data contain {roots[0]}, and regions are found for polynomials with rational coefficients"
        repair = "write a symbol in its place: the inequalities then hold for its value"
        raise InputError(message, where="specification.polynomial", repair=repair)
    names = sorted(asked.polynomial.names - {plant.variable})
    written = [name for name in names if (f := function_named(name)) is not None and not f.square]
    if written:
        message = f"{written[0]} is no polynomial, and a region is described by polynomials in its parameters"
        raise InputError(message, where="plant", repair="write a symbol in its place, or give numbers")
    degree = asked.polynomial.degree(plant.variable)
    if names and degree > MOST_DEGREE:
        message = f"a polynomial of degree {degree} with parameters, more than {MOST_DEGREE}"
        raise BudgetExceeded(message, where="specification.polynomial", repair="put numbers in place of the symbols")
    if parameters is not None:
        chosen = read_names(parameters, "parameters")
        if plant.variable in chosen:
            message = f"{plant.variable} is the variable of the polynomial"
            raise InputError(message, where="specification.parameters", repair="leave it out")
        _require_occurring(chosen, asked, plant)
    else:
        gained = {name for gain in found.values() if gain is not None for name in gain.names}
        gained |= loop.value.names - {*plant.matrices.symbols, plant.variable} if loop is not None else set()
        chosen = _free((gained or set(names)) - boundary.names or set(names), plant)
    shared = boundary.names.intersection(chosen)
    if shared:
        name = "radius" if plant.is_discrete else "margin"
        message = f"the {name} contains the parameter {min(shared)}"
        raise InputError(
            message, where=f"specification.{name}", repair="write another name, or leave it out of parameters"
        )
    return RegionQuestion(plant, found["K"], found["L"], chosen, boundary, loop)


def _read_controller(plant: StateSpace, controller: object, gains: Mapping[str, object]) -> WrittenTransferFunction:
    """Return the controller of a loop of one plant; raises `InputError` where a gain or a polynomial is given, too."""
    where = "specification.controller"
    if plant.polynomial is not None:
        repair = "keep one of them; a controller needs a plant"
        raise InputError("both a polynomial and a controller are given", where=where, repair=repair)
    for name, gain in gains.items():
        reject_both("controller", controller, gain, None, other=name)
    plant.require("B", "C", task="the controller")
    return read_transfer_function(controller, plant.symbols, plant.variable, where)


def _require_occurring(chosen: tuple[str, ...], asked: RegionQuestion, plant: StateSpace) -> None:
    """Raise `InputError` for a parameter that is neither declared nor in the data, unless they have no symbol at all."""
    data = set(plant.matrices.symbols) if plant.polynomial is None else plant.polynomial.names
    names = data.union(*(gain.names for gain in (asked.K, asked.L) if gain is not None)) - {plant.variable}
    names |= set() if asked.controller is None else asked.controller.value.names - {plant.variable}
    declared = set(plant.symbols.signs) - plant.symbols.named
    absent = [name for name in chosen if name not in names | declared | asked.boundary.names]
    if names and absent:
        near = get_close_matches(absent[0], sorted(names), 1)
        repair = f"did you mean {near[0]}? " if near else ""
        repair += f"its symbols: {', '.join(sorted(names))}; leave {absent[0]} out, or declare it in [symbols]"
        message = (
            f"the parameter {absent[0]} does not occur in the {'plant' if plant.polynomial is None else 'polynomial'}"
        )
        raise InputError(message, where="specification.parameters", repair=repair)


def _free(names: set[str], plant: StateSpace) -> tuple[str, ...]:
    """Return the names whose sign is not declared, or all of them where every one has a sign."""
    free = sorted(name for name in names if plant.symbols.sign(name) == "real")
    return tuple(free or sorted(names))


def _boundary(plant: StateSpace, margin: object, radius: object) -> StabilityBoundary:
    """Return what stable means; raises `InputError` for a margin in discrete time, a radius in continuous time."""
    name, other = ("margin", "radius") if plant.is_discrete else ("radius", "margin")
    wrong, value = (margin, radius) if plant.is_discrete else (radius, margin)
    if wrong is not None:
        message = f"a {name} is for {'continuous' if plant.is_discrete else 'discrete'} time"
        raise InputError(message, where=f"specification.{name}", repair=f"give a {other}, or leave it out")
    if value is None:
        return StabilityBoundary(plant.variable, plant.is_discrete)
    where = f"specification.{other}"
    found = read_scalar(value, plant.symbols.seen(value), where)
    if plant.variable in found.names:
        message = f"the {other} contains {plant.variable}, the variable of the polynomial"
        raise InputError(message, where=where, repair="write another name")
    signs = plant.symbols.signs
    if not plant.is_discrete:
        if sign_of(found, signs) in {"negative", "nonpositive"} and not found.is_zero:
            message = f"the margin is {found}, which is negative"
            raise InputError(message, where=where, repair="all roots shall lie in Re s < -margin: give a margin >= 0")
        return StabilityBoundary(plant.variable, margin=found)
    if sign_of(found, signs) in {"zero", "negative", "nonpositive"} or sign_of(found - 1, signs) == "positive":
        message = f"the radius is {found}, which is not between 0 and 1"
        raise InputError(
            message, where=where, repair="all roots shall lie in |z| < radius: give a radius > 0, at most 1"
        )
    return StabilityBoundary(plant.variable, discrete=True, radius=found)


@dataclass
class StabilityRegion(Result):
    """χ, its Routh table, and inequalities that hold exactly where all roots of χ are stable."""

    question: RegionQuestion

    task: ClassVar[str] = "stability_region"
    answered_by = ("stable_if",)
    letters = {"polynomial": "chi_p"}
    panels = ("region",)

    @classmethod
    def of(cls, question: RegionQuestion, method_name: str) -> StabilityRegion:
        """Return the region of a question."""
        bounds, proof = _bounds_of(question)
        table = routh_table(question.critical.headed, question.critical.parameters)
        answer = {"polynomial": question.polynomial, "routh": table, "bounds": bounds, "proof": proof}
        return cls(question.plant, method_name, answer, question)

    @property
    def critical(self) -> CriticalPolynomials:
        """Where roots can cross the boundary."""
        return self.question.critical

    @cached_property
    def region(self) -> LineRegion | PlaneRegion | None:
        """The region as intervals or cells, None where there are other symbols, or more parameters than two."""
        return region_of(self.question)

    @cached_property
    def parts(self) -> tuple[CylindricalPart, ...]:
        """The region of two parameters as bounds of one over intervals of the other."""
        return parts(self.region) if isinstance(self.region, PlaneRegion) and not self.empty else ()

    # -- claims ------------------------------------------------------------------------------------------------------

    def claims(self) -> Iterator[Claim | Statement]:
        """Yield what χ is, that the table is Routh's, and that the inequalities hold exactly on the region."""
        yield self._claim_of_polynomial()
        table: RouthTable = self.answer["routh"]
        yield Statement("the table is Routh's", lambda: "exact" if is_routh_table(table, self.critical.headed) else "")
        bounds, region = self.answer["bounds"], self.region
        if region is None:
            how = "Liénard and Chipart, products compared" + (", z3" if asks_z3(self.answer["proof"]) else "")
            yield Statement(self._says(bounds), lambda: how if self._is_proved(bounds) else "")
        if region is not None:
            how = "every cell by the roots at a point of it, the cells by Sturm's theorem"
            yield Statement(self._says(bounds), lambda: how if is_region(region, bounds) else "")
        if isinstance(region, PlaneRegion) and self.parts:
            yield Statement("the bounds over each interval", lambda: "exact" if are_parts(region, self.parts) else "")

    def _says(self, bounds: Sequence[RegionInequality] | None) -> str:
        if bounds is None:
            return "stable nowhere"
        return f"stable exactly where {' and '.join(self.stable_if)}" if bounds else "stable everywhere"

    def _is_proved(self, bounds: Sequence[RegionInequality] | None) -> bool:
        """Return whether the proof leads from the conditions of the criterion to these inequalities and back."""
        said = [Scalar.of(0)] if bounds is None else [positive_of(bound) for bound in bounds]
        chi, question = self.question.polynomial, self.question
        return is_stable_where(
            chi, self.plant.variable, said, self.signs, **question.limits, proof=self.answer["proof"]
        )

    @property
    def signs(self) -> Mapping[str, str]:
        """The declared signs."""
        return self.plant.symbols.signs

    @cached_property
    def short(self) -> Simplified | None:
        """The list of inequalities and its findings, with other symbols or many parameters."""
        return None if self.region is not None else conditions_of(self.question)

    def _claim_of_polynomial(self) -> Claim:
        """Return det(sI − A + …) = χ(s), or for a polynomial lead · det(sI − A) = χ(s)."""
        plant, m, question = self.plant, self.plant.matrices, self.question
        chi: Scalar = self.answer["polynomial"]
        values: dict[str, Any] = {"A": m.A, "chi": chi}
        values |= {"K": question.K, "B": m.B} if question.K is not None else {}
        values |= {"L": question.L, "C": m.C} if question.L is not None else {}
        if (written := question.controller) is not None:
            values |= {"B": m.B, "C": m.C, "D": m.D, "F": written.value, "f": monic(written)[1]}
        e = Environment(variable=plant.variable, values=values)
        pencil = e["A"].pencil
        if written is not None:
            return holds(e, "{whole} f (I + F (C pencil(A)^-1 B + D)) = chi I", whole=pencil.apply("det"))
        moved = [pencil + e["B"] @ e["K"]] if question.K is not None else []
        moved += [pencil + e["L"] @ e["C"]] if question.L is not None else []
        product = (moved or [pencil])[0].apply("det")
        for other in moved[1:]:
            product = product @ other.apply("det")
        if plant.polynomial is not None:
            return holds(e, "chi = {polynomial}", polynomial=plant.polynomial)
        return holds(e, "{product} = chi", product=product)

    # -- what follows ------------------------------------------------------------------------------------------------

    @property
    def empty(self) -> bool:
        """Whether nothing is stable."""
        return self.answer["bounds"] is None

    @property
    def verdict(self) -> str:
        """`yes` where everything is stable, `no` where nothing is, else `conditional`; `undecided` where that is open."""
        if self.empty:
            return "no"
        if self.region is not None:
            return "yes" if self.region.everywhere else "conditional"
        assert self.short is not None  # noqa: S101 - there is one where there is no region
        if self.short.verdict == "yes":
            return "yes"
        return "conditional" if self.short.point is not None and self.short.witnesses else "undecided"

    @cached_property
    def stable_if(self) -> list[str]:
        """The conditions as texts."""
        return stable_if(self.answer["bounds"], self.region, self.signs, self.question.parameters)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The fields of the contract."""
        found: dict[str, Any] = {
            "polynomial": self.answer["polynomial"],
            "parameters": list(self.question.parameters),
            "routh_table": [list(row.entries) for row in self.answer["routh"].rows],
            "stable_if": self.stable_if,
            "empty": self.empty,
        }
        region = self.region
        if isinstance(region, LineRegion):
            found |= intervals_of(region)
        elif self.short is not None:
            found |= of_conditions(self.short, self.question)
        if isinstance(region, PlaneRegion) and self.critical.never:
            found |= {"bounded": True, "cells": [], "components": [], "excluded_points": [], "sample_points": []}
        elif isinstance(region, PlaneRegion):
            found |= {"bounded": self.empty or region.bounded}
            found |= {"cells": cells_of(region), "components": components_of(region, self.parts)}
            found |= excluded_of(region)
        return found

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """What is true where the coefficient of a parameter is positive, negative or zero, if its sign is open."""
        if self.short is None or self.verdict != "conditional":
            return ()
        found = sign_cases(self.short.positive, self.question.parameters, self.signs)
        if len(found) < 2 or any(case.assumed or len(case.when) > 1 for case in found):
            return ()
        return tuple(case for case in map(self._case, found) if case is not None)

    def _case(self, case: SignCase) -> Case | None:
        """Return the result where a coefficient has a sign; None where there is no polynomial."""
        try:
            chi = self.answer["polynomial"].substitute(case.substitution)
        except ZeroDivisionError:
            return None
        when = tuple(Condition("case", value, operator) for value, operator in case.when)
        variable, question = self.plant.variable, self.question
        if chi.degree(variable) != self.answer["polynomial"].degree(variable):
            return Case(when, case.substitution, None)
        symbols = replace(self.plant.symbols, signs=case.signs)
        plant = StateSpace.from_polynomial(chi, self.plant.dt, symbols=symbols)
        names = tuple(name for name in question.parameters if name in chi.names)
        return Case(
            when,
            case.substitution,
            type(self).of(
                RegionQuestion(plant, None, None, names, question.boundary.substitute(case.substitution)), self.method
            ),
        )

    @cached_property
    def picture(self) -> Picture | None:
        """The region of two parameters; of one parameter the paths of the roots, or the line where they run off."""
        if isinstance(self.region, LineRegion):
            return self.pole_map or picture_of_line(self.region)
        if isinstance(self.region, PlaneRegion) and not self.critical.never:
            return oriented(picture_of_plane(self.region), self.question.parameters)
        if self.region is None and not self.empty:
            return picture_with_symbols(self.critical, self.question.parameters, self.question.symbols)
        return None

    @cached_property
    def pole_map(self) -> PoleMap | None:
        """The paths of the roots as the one parameter moves."""
        if not isinstance(self.region, LineRegion):
            return None
        return pole_map(self.region, self.answer["polynomial"], self.question.boundary)


def _bounds_of(question: RegionQuestion) -> tuple[tuple[RegionInequality, ...] | None, Equivalence | None]:
    """Return inequalities that hold exactly on the region, None where it is empty, and the proof where it is no region."""
    region = region_of(question)
    if region is not None:
        return (None if region.critical.never or region.empty else short_list(region)), None
    found = conditions_of(question)
    bounds = None if found.verdict == "no" else tuple(map(bound_of, found.positive))
    return bounds, found.equivalence


@lru_cache(maxsize=16)
def conditions_of(question: RegionQuestion) -> Simplified:
    """Return a short list of what must be positive, with its proof."""
    return stable_where(question.polynomial, question.plant.variable, question.plant.symbols.signs, **question.limits)


def bound_of(positive: Scalar) -> RegionInequality:
    """Return a value > 0, a square as its root ≠ 0."""
    root = root_of_square(positive)
    return RegionInequality(positive) if root is None else RegionInequality(root, "!=")


def positive_of(bound: RegionInequality) -> Scalar:
    """Return the expression that an inequality states to be positive."""
    return bound.polynomial if bound.operator == ">" else bound.polynomial**2


def region_of(question: RegionQuestion) -> LineRegion | PlaneRegion | None:
    """Return the exact region of one or two parameters, None where there are other symbols, or more than two."""
    return None if question.symbols else exact_region(question.critical, question.parameters)


@method("stability_region/routh", source="routh1877; collins1975")
def by_routh(question: RegionQuestion) -> StabilityRegion:
    """Routh's table, the conditions, and the exact region of one or two parameters."""
    return StabilityRegion.of(question, "routh")


@task
def stability_region(
    plant: StateSpace | object = None,
    symbols: Mapping[str, Any] | None = None,
    dt: object = 0,
    *,
    polynomial: PolynomialText = None,
    K: GainText = None,
    L: GainText = None,
    controller: TransferFunctionText = None,
    parameters: Names = None,
    margin: Quantity = None,
    radius: Quantity = None,
    method: Name = "auto",
) -> Result:
    """Find the parameters for which all roots of χ are stable: exact inequalities, intervals, cells of the plane.

    plant          a plant, or a polynomial as a text: "s^2 + (b + h2) s + omega^2 (1 - h1)"
    symbols, dt    for a polynomial: the signs of its symbols, and dt as for a plant (0 continuous: s, else z)
    polynomial     the polynomial, instead of a plant
    K, L           gains with free entries, "[h1; h2]": χ(s) = det(sI − A + BK), det(sI − A + LC), or their product
    controller     F(s) with free letters, "k" or "Kp + Ki/s + Kd*s": χ(s) is the numerator of 1 + F(s)G(s), nothing cancelled
    parameters     the names to find the region of; else the free names of the gains, else those without a sign
    With a dead time at the input of the plant: one gain, "k" or "k*(1 + 1/s)"; ends are exact, or have twelve certain digits.
    margin         α ≥ 0: all roots in Re s < −α           radius   0 < ρ ≤ 1, discrete time: all roots in |z| < ρ
    Returns polynomial, routh_table, stable_if; for one parameter intervals, for two cells, components, excluded_points;
    empty, bounded, sample_points.  One and two parameters without other symbols: exact; otherwise equivalent conditions.
    Raises `InputError` where there is neither a polynomial nor a plant with the matrices of its gains, for a gain of
    another shape, a name that is no parameter, and a margin or radius out of range.
    Source: E. J. Routh (1877); A. Hurwitz (1895); G. E. Collins (1975) for cells of the plane.
    """
    where = "specification.parameters"
    if isinstance(plant, StateSpace):
        asked = plant.with_symbols(plant.symbols.naming(parameters, where))
        if polynomial is not None and plant.polynomial is None:
            asked = StateSpace.from_polynomial(polynomial, plant.dt, symbols=asked.symbols)
    else:
        known = Symbols.of(symbols).naming(parameters, where)
        asked = StateSpace.from_polynomial(plant if polynomial is None else polynomial, dt, symbols=known)
    if asked.delay is not None:
        from symobs.tasks.analysis.stability_region.delayed_region import delayed_region  # noqa: PLC0415 - dead times alone

        others = {"K": K, "L": L, "margin": margin, "radius": radius, "polynomial": polynomial}
        return delayed_region(asked.in_digits(), controller, parameters, others).asked(method)
    question = read_question(asked.in_digits(), {"K": K, "L": L}, parameters, margin, radius, controller)
    return choose("stability_region", method, "routh").solve(question).asked(method)
