"""For which parameters are all roots stable: conditions, exact intervals, the exact decomposition of the plane."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import Scalar
from symobs.formula.tree import Environment
from symobs.formula.tree.term import identity, letter
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import Claim, Statement
from symobs.proof.derivation.builder import relation
from symobs.stability.criteria.routh_table import RouthTable, is_routh_table, routh_table
from symobs.stability.criteria.stability_conditions import is_stable_where, stable_where
from symobs.stability.inequalities.proof import asks_z3
from symobs.stability.inequalities.sign_cases import SignCase, sign_cases
from symobs.stability.inequalities.written_form import root_of_square
from symobs.stability.plots.region_plot import oriented, picture_of_line, picture_of_plane
from symobs.stability.plots.region_plot_with_symbols import picture_with_symbols
from symobs.stability.plots.root_locus import pole_map
from symobs.stability.regions.description import parts
from symobs.stability.regions.interval_region import LineRegion
from symobs.stability.regions.plane_region import PlaneRegion
from symobs.stability.regions.region_check import are_parts, is_region
from symobs.stability.regions.region_for import exact_region
from symobs.stability.regions.short_list import RegionInequality, short_list
from symobs.system import StateSpace, Symbols
from symobs.system.conditions import Condition
from symobs.tasks.analysis.stability_region.stability_region_fields import (
    cells_of,
    components_of,
    excluded_of,
    intervals_of,
    of_conditions,
    stable_if,
)
from symobs.tasks.analysis.stability_region.stability_region_question import RegionQuestion, read_question
from symobs.tasks.result import Case, Result, choose, method, task

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.formula.figures.plot import Picture, PoleMap
    from symobs.stability.criteria.critical_polynomials import CriticalPolynomials
    from symobs.stability.inequalities.proof import Equivalence
    from symobs.stability.inequalities.simplify import Simplified
    from symobs.stability.regions.description import CylindricalPart
    from symobs.system.specification import GainText, Name, Names, PolynomialText, Quantity


@dataclass(frozen=True, eq=False, repr=False)
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
        e = Environment(variable=plant.variable, values=values)
        pencil = letter("s", e) @ identity(plant.order, e) - letter("A", e)
        moved = [pencil + letter("B", e) @ letter("K", e)] if question.K is not None else []
        moved += [pencil + letter("L", e) @ letter("C", e)] if question.L is not None else []
        product = (moved or [pencil])[0].apply("det")
        for other in moved[1:]:
            product = product @ other.apply("det")
        if plant.polynomial is not None:
            return Claim(relation(letter("chi", e), plant.polynomial), e)
        return Claim(relation(product, letter("chi", e)), e)

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
    parameters     the names to find the region of; else the free names of the gains, else those without a sign
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
    question = read_question(asked, {"K": K, "L": L}, parameters, margin, radius)
    return choose("stability_region", method, "routh").solve(question).asked(method)
