"""The page of a stability region: the polynomial, Routh's table, where roots can cross, the inequalities, the region."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from symobs.exact import Scalar
from symobs.formula.phrases.languages import Counted
from symobs.formula.tree import HoldsExactlyWhere, Literal, Power, Product, Quotient, Sum, SymbolList
from symobs.proof.derivation import CaseStep, Conclude, Inequalities, RegionSummary, Step
from symobs.proof.derivation.builder import predicate, relation, sentence
from symobs.proof.derivation.region_check import findings_of_conditions, findings_of_region, interval_relations
from symobs.stability.criteria.stability import hurwitz_matrix
from symobs.stability.plots import picture_of_line
from symobs.stability.regions.description import are_whole, is_written, relations_of
from symobs.stability.regions.region import LineRegion, PlaneRegion
from symobs.system.conditions import sign_of
from symobs.system.transfer_function_text import WrittenTransferFunction
from symobs.tasks.analysis.page_parts import WRITTEN_UP_TO, determinant_form, given, state_signs
from symobs.tasks.analysis.stability_region.stability_region import StabilityRegion, solved
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from symobs.formula.tree import Formula, Relation
    from symobs.proof.derivation.builder import Builder
    from symobs.tasks.result import Case

#: A region in more parts than this is left to its inequalities and its picture.
MOST_PARTS = 8
#: Findings that say how a region was found.
NUMBERS = {"number_is_root", "numbers_are_roots"}
HOW = {"zeros_decide", "zero_decides", "values_decide", "cells_decide", "cells_decide_discrete"}
#: Hurwitz' matrix is written out up to this order.
WRITTEN_ORDER = 4


@page_of(StabilityRegion)
def write_region(page: Builder, result: StabilityRegion) -> None:
    """Write the whole page."""
    question = result.question
    if question.plant.polynomial is not None:
        with page.section("given"):
            page.given(relation(page["chi_p"], question.plant.polynomial))
            page.environment = page.environment.extended_by(values={"chi_p": question.plant.polynomial})
            if result.plant.is_from_floats:
                page.remark("from_floats")
            state_signs(page)
        chi = "chi_p"
    else:
        given(page)
        chi = ""
    with page.section("stability_region"):
        if not chi:
            chi = _polynomial_of_loop(page, result)
        _sought(page, result)
        _say_open_loop(page, result)
        moved = _moved(page, result, chi)
        _table(page, result, moved)
        if result.region is not None:
            if result.critical.proper:
                _crossing(page, result, moved)
            _region(page, result, chi, moved)
        elif result.question.parameters:
            _conditions(page, result, moved)


def write_line(page: Builder, result: StabilityRegion, chi: str) -> None:
    """Write where a polynomial is stable as one parameter moves, without Routh's table where there are no other symbols."""
    if result.region is None:
        _table(page, result, chi)
        _conditions(page, result, chi)
        return
    if result.critical.proper:
        _crossing(page, result, chi)
    _region(page, result, chi, chi)


def _say_open_loop(page: Builder, result: StabilityRegion) -> None:
    """Say how a loop is asked for where parameters stand in the numerator of a transfer function alone."""
    written, chi = result.plant.written, result.answer["polynomial"]
    if not isinstance(written, WrittenTransferFunction) or {result.question.K, result.question.L} != {None}:
        return
    if chi.names <= {page.plant.variable} and not written.above.names <= {page.plant.variable}:
        page.remark("open_loop_asked", polynomial=str(written.above + written.below))


def _polynomial_of_loop(page: Builder, result: StabilityRegion) -> str:
    """Establish the gains and the characteristic polynomial; return its letter."""
    question = result.question
    chi: Scalar = result.answer["polynomial"]
    for name, gain in (("K", question.K), ("L", question.L)):
        if gain is not None:
            page.define(name, gain, say="gain_open", closing=False)
    pencil = page["pencil(A)"]
    moved = {
        "chi_K": page["pencil(A) + B K"] if question.K is not None else None,
        "chi_L": page["pencil(A) + L C"] if question.L is not None else None,
    }
    used = {name: term for name, term in moved.items() if term is not None} or {"chi": pencil}
    for name, term in used.items():
        own = chi if len(used) == 1 else term.apply("det").scalar
        page.define(name, term.apply("det"), term.as_value.apply("det"), own, say="polynomial_of_loop", closing=False)
    if len(used) == 1:
        return next(iter(used))
    page.define("chi_cl", "chi_K chi_L", say="polynomial_of_loop", closing=False)
    return "chi_cl"


def _sought(page: Builder, result: StabilityRegion) -> None:
    """State the question."""
    boundary, names = result.question.boundary, _listed(result)
    if not result.question.parameters:
        if not boundary.is_usual:
            name, limit = ("radius", boundary.radius) if boundary.discrete else ("margin", -boundary.margin)
            page.remark(f"wanted_{name}", limit=limit)
    elif boundary.is_usual:
        page.remark("sought_discrete" if boundary.discrete else "sought_continuous", names=names)
    elif boundary.discrete:
        page.remark("sought_radius", names=names, limit=boundary.radius)
    else:
        page.remark("sought_margin", names=names, limit=-boundary.margin)


def _listed(result: StabilityRegion) -> SymbolList:
    return SymbolList(result.question.parameters)


def _moved(page: Builder, result: StabilityRegion, chi: str) -> str:
    """Move the boundary to where it usually is, q(s) = χ(s − α) or q(z) = χ(ρ z); return the letter."""
    boundary = result.question.boundary
    if boundary.is_usual:
        return chi
    argument = page.s * boundary.radius if boundary.discrete else page("s - {margin}", margin=boundary.margin)
    value = boundary.moved(result.answer["polynomial"])
    say = "enlarged" if boundary.discrete else "moved_right"
    by = boundary.radius if boundary.discrete else boundary.margin
    page.define("q_s", argument.apply(f"{chi}_at"), value, say=say, closing=False, by=by)
    page.remark("unit_disc" if boundary.discrete else "left_half_plane")
    return "q_s"


def _table(page: Builder, result: StabilityRegion, chi: str) -> None:
    """Show Routh's table, in discrete time of the polynomial that the bilinear map makes."""
    if not result.question.boundary.discrete:
        page.tabulate(page[chi], say="routh_table", polynomial=page[chi])
        return
    if result.critical.written[0].is_zero:  # 1 is a root, which the map carries to infinity: no table shows it
        page.remark("root_on_circle")
        page.equal(relation(page["1"].apply(f"{chi}_at"), 0))
        return
    taken = result.plant.symbols.signs.keys() | result.answer["polynomial"].names
    name_of_w = next((name for name in ("w", "v") if name not in taken), None)
    if name_of_w is None:  # the conditions stand without their table
        return
    w = Scalar.symbol(name_of_w)
    image = page.term(Quotient(Literal(w + 1), Literal(w - 1)))
    order = result.critical.order
    powers = [(c, order - k) for k, c in enumerate(result.critical.written) if not c.is_zero]
    value = page.term(Sum(tuple(_of_power(c, w, power) for c, power in powers)))
    name = f"{chi}_at"
    product = page.value(w - 1) ** order * image.apply(name)
    scale = result.critical.scale
    if not scale.is_one:
        product = page.value(scale) * product
    say = "mapped" if name_of_w == "w" else "mapped_from_v"
    q = page.define(f"q_{name_of_w}", product, value, say=say, closing=False, image=image)
    page.tabulate(q, name_of_w, say="routh_table", polynomial=q)


def _of_power(coefficient: Scalar, w: Scalar, power: int) -> Formula:
    """Return coefficient · wᵖ."""
    raised: Formula = Literal(w) if power == 1 else Power(Literal(w), power)
    parts: list[Formula] = [Literal(coefficient)] if not coefficient.is_one or not power else []
    parts += [raised] if power else []
    return parts[0] if len(parts) == 1 else Product(tuple(parts))


def _crossing(page: Builder, result: StabilityRegion, chi: str) -> None:
    """Show the critical polynomials."""
    critical = result.critical
    vary = Counted("varies", len(result.question.parameters))
    name = f"{chi}_at"
    places = (1, -1) if critical.boundary.discrete else (0,)
    shown: list[Relation] = []
    for place in places:
        value = page.value(place).apply(name)
        shown.append(relation(value, determinant_form(page, value.scalar)))
    if critical.boundary.discrete:
        key = "crossing_discrete" if critical.order > 1 else "crossing_one_discrete"
    elif not critical.written[0].is_constant:
        key = "crossing_infinite"
    else:
        key = "crossing" if critical.order > 1 else "crossing_one"
    page.remark(key, names=_listed(result), vary=vary)
    page.equal(*shown)
    last = critical.order - 1
    if last < 1:
        return
    hurwitz = hurwitz_matrix(critical.written).select(range(last), range(last))
    determinant = hurwitz.determinant()
    if 1 < last <= WRITTEN_ORDER:
        members = [page("det({hurwitz})", hurwitz=hurwitz), determinant_form(page, determinant)]
    else:
        members = [determinant_form(page, determinant)]
    page.define(f"Delta_{last}", *members, closing=False)
    if critical.never:
        page.remark("always_critical")


def _conditions(page: Builder, result: StabilityRegion, chi: str) -> None:
    """Show the conditions of the criterion, the equivalent short list, and the findings on its shape."""
    short, signs, names = result.short, result.signs, result.question.parameters
    assert short is not None  # noqa: S101 - there is one where there is no region
    stable = predicate("stable", page[chi])
    findings = findings_of_conditions(
        page[chi].scalar, page.environment, names, discrete=result.question.boundary.discrete
    )
    if result.empty:
        page.steps.append(RegionSummary(page[chi].formula, names, findings))
        return
    relations = inequalities(result)
    raw = short.equivalence.raw
    known = tuple(relation(value, ">", 0) for value in raw if sign_of(value, signs) != "positive")
    say = "region_is"
    if relations and len(known) > len(relations):
        say = "shortened"
        if sum(value.size for value in raw) <= WRITTEN_UP_TO:
            page.steps.append(Inequalities(HoldsExactlyWhere(stable, known), sentence("criterion", {})))
        else:
            page.remark("criterion_long", count=str(len(raw)))
    if relations:
        page.steps.append(Inequalities(HoldsExactlyWhere(stable, relations), sentence(say, {}), answer=True))
    if findings:
        page.steps.append(RegionSummary(page[chi].formula, names, findings))
    page.steps += [_case(page, case, chi) for case in result.case_tree if case.result is not None]
    weak = {"nonnegative", "nonpositive"}.intersection(map(signs.get, names))
    if not result.question.symbols and len(names) == 2 and not weak:
        page.remark("not_divided")
    if result.picture is not None:
        page.plot(result.picture, page[chi])


def _case(page: Builder, case: Case, chi: str) -> Step:
    """Say where all roots are stable if a coefficient has a certain sign."""
    found = cast("StabilityRegion", case.result)
    (condition,) = case.when
    when = relation(condition.expression, condition.operator.replace("==", "="), 0)
    stable = predicate("stable", page[chi])
    steps: tuple[Step, ...]
    if found.empty:
        names = found.question.parameters
        steps = (RegionSummary(page[chi].formula, names, (sentence("region_empty", {}),)),)
    elif not found.answer["bounds"]:
        steps = (Conclude(sentence("case_everywhere", {}), (stable,)),)
    else:
        steps = (Inequalities(HoldsExactlyWhere(stable, inequalities(found)), sentence("case_region", {})),)
    return CaseStep(when, tuple(case.substitution.items()), steps)


def _region(page: Builder, result: StabilityRegion, written: str, chi: str) -> None:
    """Show the inequalities, the region in words and parts, and the pictures, below the inequalities where there are any."""
    region = result.region
    assert region is not None  # noqa: S101 - there is one here
    found = findings_of_region(region)
    names = (region.name,) if isinstance(region, LineRegion) else region.names
    decided = tuple(finding for finding in found if finding.key in HOW)
    if decided:
        page.steps.append(RegionSummary(page[chi].formula, names, decided))
    if result.empty:
        page.steps.append(RegionSummary(page[chi].formula, names, found))
        return
    relations = inequalities(result)
    if relations:
        fact = HoldsExactlyWhere(predicate("stable", page[chi]), relations)
        page.steps.append(Inequalities(fact, sentence("region_is", {}), answer=True))
        _pictures(page, result, written, chi)
    parts = _parts(result, region)
    others = tuple(finding for finding in found if finding not in decided and finding.key not in NUMBERS)
    if others or parts:
        numbers = tuple(finding for finding in found if finding.key in NUMBERS) if parts else ()
        say = sentence("parts_are", {}) if parts else None
        page.steps.append(RegionSummary(page[chi].formula, names, others, parts, say))
        if numbers:
            page.steps.append(RegionSummary(page[chi].formula, names, numbers))
    if not relations:
        _pictures(page, result, written, chi)


def _pictures(page: Builder, result: StabilityRegion, chi: str, moved: str) -> None:
    """Draw the region, and of one parameter the paths of the roots."""
    if result.empty or result.critical.never:
        return
    if isinstance(result.region, LineRegion):
        if result.region.points:
            page.plot(picture_of_line(result.region), page[moved])
        if result.pole_map is not None:
            page.plot(result.pole_map, page[chi], say="poles_move", names=_listed(result))
    elif result.picture is not None:
        page.plot(result.picture, page[moved])


def inequalities(result: StabilityRegion) -> tuple[Relation, ...]:
    """Return the inequalities that hold exactly where all roots are stable; of a single interval its ends."""
    region = result.region
    if isinstance(region, LineRegion) and len(region.intervals) == 1 and not region.cuts:
        is_bounded_by_sign = region.name not in region.critical.parameters
        return () if is_bounded_by_sign else tuple(r for found in interval_relations(region) for r in found)
    names = result.question.parameters
    return tuple(relation(*solved(bound, result.signs, names)) for bound in result.answer["bounds"] or ())


def _parts(result: StabilityRegion, region: object) -> tuple[tuple[Relation, ...], ...]:
    if isinstance(region, LineRegion):
        return tuple(interval_relations(region)) if len(region.intervals) > 1 else ()
    parts = result.parts
    assert isinstance(region, PlaneRegion)  # noqa: S101 - the other kind
    if not 0 < len(parts) <= MOST_PARTS or not all(map(is_written, parts)) or not are_whole(region, parts):
        return ()
    found = tuple(relations_of(part, region.names) for part in parts)
    return found if all(found) else ()
