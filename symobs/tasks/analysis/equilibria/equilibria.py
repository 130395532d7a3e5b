"""The equilibria of ẋ = f(x, u), each with its conditions and the stability of its linearisation."""

from __future__ import annotations

from contextlib import contextmanager
from fractions import Fraction
from functools import cached_property
from math import ceil, floor
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import Ideal, Matrix, Scalar, modulo
from symobs.exact.algebraic.enclosure import sign_of_number
from symobs.exact.algebraic.isolation import digits_on, sign_on
from symobs.exact.core.generators import NotWritten, all_roots, derivative, identities, normal_form
from symobs.formula.tree import At, Environment, Literal, Relation, SymbolList
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.proof.derivation.facts import on_stratum
from symobs.proof.derivation.steps import CaseStep
from symobs.stability.criteria.stability import stability
from symobs.system.conditions import sign_where
from symobs.system.decided_signs import by_signs, without_squares
from symobs.system.linearize import all_equilibria, is_rate
from symobs.system.motion import simplified, with_primes
from symobs.system.reading import Nonlinear
from symobs.tasks.analysis.equilibria.branches import picture_of
from symobs.tasks.analysis.linearisation_page import partial_derivatives, state_nonlinear
from symobs.tasks.analysis.page_parts import say_stability, state_signs
from symobs.tasks.result import Result, choose, method, task
from symobs.tasks.result.output_methods import to_sympy

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.formula.figures import BranchPicture
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.equilibria import Equilibria as Found
    from symobs.system.equilibria import Equilibrium
    from symobs.system.equilibrium_search import Enclosure
    from symobs.system.specification import Name


@dataclass
class Equilibria(Result):
    """Points with f = 0, which are all there are where the search left nothing open."""

    task: ClassVar[str] = "equilibria"
    answered_by = ("points", "stable")

    @property
    def found(self) -> Found:
        """The points and what is left open."""
        found: Found = self.answer["found"]
        return found

    @property
    def given(self) -> Nonlinear:
        """The plant whose equilibria they are."""
        return nonlinear_of(self.plant)

    def claims(self) -> Iterator[Claim]:
        """Yield f = 0 (x in discrete time) at each point, and the matrix of the linearisation there."""
        for number, point in enumerate(self.found.points, 1):
            values = Matrix.column(self._rest(point))
            yield Claim(relation(values, values * 0), self._environment(point, values), f"f = 0 at {_text(point)}")
            if point.within is not None:
                yield self._sign_change(point.within)
            if (A := self.matrix_at(point)) is not None:
                raw = self.jacobian.substitute(self.values_at(point))
                yield Claim(
                    relation(raw, A), self._environment(point, raw, A), f"the linearisation at equilibrium {number}"
                )

    def _sign_change(self, within: Enclosure) -> Claim:
        """Return the claim that what is 0 at a point that is known by numbers changes its sign around it."""
        zero = Literal(Scalar.of(0))
        (low, below), (high, _) = _ends(within)
        there = (
            At(Literal(within.equation), within.name, end)
            for end in ((low, high) if below == "negative" else (high, low))
        )
        rising = Relation((next(there), zero, next(there)), ("<", "<"))
        return Claim(rising, Environment(variable=self.plant.variable), f"a change of sign at {within.name}")

    def _environment(self, point: Equilibrium, *values: Matrix) -> Environment:
        """Return an environment in which functions have their identities, roots their signs, and the point is one."""
        relations = (*identities(values)[1], *(zero for value in values for zero in self._roots_by_signs(value)))
        relations += tuple(_zeros(point))
        return Environment(variable=self.plant.variable, relations=relations, signs=self.signs_at_rest)

    def _roots_by_signs(self, value: Matrix) -> list[Scalar]:
        """Return what vanishes since the signs of the parameters decide roots of squares."""
        differences = (root.value - by_signs(root.value, self.signs_at_rest) for root in all_roots(value))
        return [difference.numerator for difference in differences if not difference.is_zero]

    def _rest(self, point: Equilibrium) -> list[Scalar]:
        """Return what is 0 at an equilibrium, at a point."""
        values = {**self._known, **point.values}
        return self.given.at_rest(values, is_discrete=self.plant.is_discrete)

    @property
    def _known(self) -> dict[str, Scalar]:
        return known_of(self.given)

    @property
    def signs_at_rest(self) -> dict[str, str]:
        """The signs of parameters, states and inputs."""
        names = self.given.states + self.given.inputs
        return {**self.plant.symbols.signs, **{name: self.plant.symbols.sign(name) for name in names}}

    @property
    def verdict(self) -> str:
        """`no` where there is none, `undecided` where there may be others, `conditional` where each needs a condition."""
        if not self.found.are_all:
            return "undecided"
        if not self.found.points:
            return "no"
        return "conditional" if all(point.conditions for point in self.found.points) else "yes"

    @property
    def conditions(self) -> tuple[Any, ...]:
        """The conditions of each point as SymPy relations."""
        found: tuple[Any, ...] = to_sympy([point.conditions for point in self.found.points], self.plant.symbols.objects)
        return found

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The points by the names of states and inputs, the conditions of each, and whether its linearisation is stable."""
        points, stable = self.found.points, [self.stability_at(point) for point in self.found.points]
        question = {} if self.found.are_all else {"question": f"{self.found.open_equations[0]} = 0 has no closed form"}
        return {
            "points": [self._named(point) if point.within is None else self._digits(point) for point in points],
            "conditions": [[*point.conditions] for point in points],
            "stable": [verdict for verdict, _ in stable],
            "stable_if": [inequalities for _, inequalities in stable],
            "complete": self.found.are_all,
            **question,
        }

    def _named(self, point: Equilibrium) -> dict[str, Scalar]:
        """Return the values of the states and inputs in their order, by the names as they are typed."""
        given, values = self.given, self.values_at(point)
        named = with_primes if given.motion is not None else str
        return {named(name): values[name] for name in given.states + given.inputs}

    def _digits(self, point: Equilibrium) -> dict[str, Scalar | str]:
        """Return the same of a point that is known by numbers: certain digits, and what is exact."""
        within, exact = point.within, self._named(point)
        assert within is not None  # noqa: S101 - the caller has looked
        return {
            name: value if value.is_constant else digits_on(value, within.name, within.interval, _DIGITS)
            for name, value in exact.items()
        }

    @property
    def jacobian(self) -> Matrix:
        """∂f/∂x."""
        return self.given.jacobian(self.given.f, self.given.states)

    def values_at(self, point: Equilibrium) -> dict[str, Scalar]:
        """Return the value of each state and input at a point."""
        at_rest = {name: Scalar.of(0) for name in self.given.states if is_rate(name, self.given)}
        return {**at_rest, **self._known, **point.values}

    def matrix_at(self, point: Equilibrium) -> Matrix | None:
        """Return ∂f/∂x at a point, None where f has no derivative that is written there."""
        try:
            value = self.jacobian.substitute(self.values_at(point))
            rows = [
                [simplified(normal_form(by_signs(entry, self.signs_at_rest))) for entry in row] for row in value.rows
            ]
        except (ZeroDivisionError, NotWritten):
            return None
        zeros = _zeros(point) if point.within is None else []
        return modulo(Matrix.of(rows), Ideal.of(zeros)) if zeros else Matrix.of(rows)

    def polynomial_at(self, point: Equilibrium) -> Scalar | None:
        """Return the characteristic polynomial at a point, None where f has no derivative that is written there."""
        A = self.matrix_at(point)
        return None if A is None else _simple(A.characteristic_polynomial(self.plant.variable))

    @cached_property
    def picture(self) -> BranchPicture | None:
        """The equilibria over the parameter, where there is one."""
        return picture_of(self)

    def stability_at(self, point: Equilibrium) -> tuple[str, list[str]]:
        """Return whether the linearisation at a point is asymptotically stable, and where that needs conditions."""
        if (polynomial := self.polynomial_at(point)) is None:
            return "undecided", []
        found = stability(polynomial, self.plant.variable, self.signs_at_rest, discrete=self.plant.is_discrete)
        told = [condition.expression for condition in point.conditions if condition.operator == ">"]
        if point.within is not None and found.verdict == "conditional":
            signs = [sign_on(value, point.within.name, point.within.interval) for value in found.positive]
            return ("no" if -1 in signs else "yes" if all(signs) else "undecided"), []
        left = [value for value in found.positive if sign_where(value, self.signs_at_rest, told) != "positive"]
        if found.verdict == "conditional" and not left:
            return "yes", []
        return found.verdict, found.inequalities(self.signs_at_rest) if left else []

    def write(self, page: Builder) -> None:
        """Write the plant, what vanishes at rest, and each equilibrium with its linearisation."""
        given, found = self.given, self.found
        with page.section("given"):
            state_nonlinear(page, given)
            state_signs(page)
        with page.section("equilibria"):
            self._tell_equations(page)
            if not found.are_all:
                page.remark("equilibria_found", equation=found.open_equations[0])
            elif len(found.points) == 1:
                page.remark("equilibria_one")
            elif found.points:
                page.remark("equilibria_all", number=str(len(found.points)))
            else:
                page.remark("equilibria_none")
            if self.picture is not None:
                page.plot(self.picture, page["f_x"])
        for number, point in enumerate(found.points, 1):
            with page.section("equilibrium_numbered", number=str(number)):
                self._tell(page, number, point)

    def _tell_equations(self, page: Builder) -> None:
        """Tell what vanishes at rest: f without rates, with the inputs that are given."""
        given = self.given
        at_rest = {name: Scalar.of(0) for name in given.states if is_rate(name, given)} | self._known
        value = given.f.substitute(at_rest)
        time = "discrete" if self.plant.is_discrete else "continuous"
        page.in_time_by(*identities([value]))
        if at_rest:
            page.equal(relation(_at(page["f_x"], at_rest), value), say=f"at_rest_{time}")
        else:
            page.remark(f"at_rest_as_given_{time}")

    def _tell(self, page: Builder, number: int, point: Equilibrium) -> None:
        """Tell where there is a point, and there the point, f and the linearisation."""
        for condition in point.conditions:
            if condition.operator == "==":
                page.remark("rests_where_zero", value=condition.expression)
        with _where(page, point):
            self._tell_point(page, number, point)
            if any(condition.operator == ">=" for condition in point.conditions):
                page.remark("rests_at_the_edge")

    def _tell_point(self, page: Builder, number: int, point: Equilibrium) -> None:
        """Tell a point, f there, and the linearisation."""
        if point.within is not None:
            self._tell_enclosed(page, point, point.within)
            return
        given, values = self.given, self.values_at(point)
        moved = given.f.substitute(values)
        page.in_time_by(*identities([moved]))
        page.where(*self._roots_by_signs(moved))
        self._tell_values(page, number, point, values)
        if point.free:
            page.remark("free_at_rest", names=SymbolList(point.free))
        if _zeros(point):  # what is 0 there is not 0 elsewhere on the page
            return
        everything = {name: values[name] for name in (*given.states, *given.inputs)}
        time = "discrete" if self.plant.is_discrete else "continuous"
        rest = Matrix.column([values[name] if self.plant.is_discrete else Scalar.of(0) for name in given.states])
        page.equal(relation(_at(page["f_x"], everything), rest), say=f"is_at_rest_{time}")
        if (A := self.matrix_at(point)) is not None and number <= MOST_LETTERS:
            self._tell_linearisation(page, f"A_e{number}", A, values)

    def _tell_values(self, page: Builder, number: int, point: Equilibrium, values: Mapping[str, Scalar]) -> None:
        """Tell the states of a point, and its inputs where these are not given, each as an answer."""
        inputs = tuple(name for name in self.given.inputs if name not in self._known)
        if number > MOST_LETTERS:
            names, entries = tuple(point.values), [*point.values.values()]
            page.remark("an_equilibrium", names=SymbolList(names), values=Matrix.row(entries))
            return
        for letter, names in (("x", self.given.states), ("u", inputs)):
            if names:
                column = Matrix.column([values[name] for name in names])
                value = column if len(names) > 1 else column[0, 0]
                shown = page.set(f"{letter}_e{number}", value)
                page.equal(relation(shown, value), say=f"rests_{letter}", names=SymbolList(names), answer=True)

    def _tell_enclosed(self, page: Builder, point: Equilibrium, within: Enclosure) -> None:
        """Tell a point that is known by numbers: where what is left changes its sign, certain digits, and the stability."""
        names, equations = tuple(point.values), [each.within.equation for each in self.found.points if each.within]
        letter = f"g_e{equations.index(within.equation) + 1}"
        if not page.environment.defines(letter):
            shown = page.set(letter, within.equation)
            page.equal(relation(shown, within.equation), say="has_one_zero", unknown=SymbolList((within.name,)))
        page.equal(
            *(relation(page[letter].at(within.name, end), _SIDES[sign], 0) for end, sign in _ends(within)),
            say="changes_its_sign",
        )
        digits = (digits_on(value, within.name, within.interval, _DIGITS_ON_PAGE) for value in point.values.values())
        page.remark("an_equilibrium_by_numbers", names=SymbolList(names), values=", ".join(digits))
        page.remark(f"enclosed_{self.stability_at(point)[0]}")

    def _tell_linearisation(self, page: Builder, letter: str, A: Matrix, values: Mapping[str, Scalar]) -> None:
        """Tell the matrix at a point, by partial derivatives where no root is written that it has not, and its stability."""
        given = self.given
        raw = self.jacobian.substitute(values)
        page.in_time_by(*identities([A]))
        if all_roots(raw) <= all_roots(A) | all_roots(Matrix.column([*values.values()])):
            page.in_time_by(*identities([raw]))
            columns = page.term(partial_derivatives("f_x", self.jacobian, given.states))
            for name in (*given.states, *given.inputs):
                columns = columns.at(name, values[name])
            page.define(letter, columns, A, say="linearised_there", closing=False)
        else:
            page.equal(relation(page.set(letter, A), A), say="linearised_there")
        determinant, value = page(f"det(pencil({letter}))"), _simple(A.characteristic_polynomial(self.plant.variable))
        if all_roots(A) and not all_roots(value):
            determinant = page.define(f"chi_e{letter[3:]}", determinant, value)
        else:
            page.equal(relation(determinant, value))
        say_stability(page, determinant)


#: The digits of a point that is known by numbers; on a page fewer.
_DIGITS, _DIGITS_ON_PAGE = 12, 6
#: As many linearisations have a letter of their own.
MOST_LETTERS = 9
_SIDES = {"positive": ">", "negative": "<"}
_STRICT = {">": ">", ">=": ">", "!=": "!="}


def _zeros(point: Equilibrium) -> list[Scalar]:
    """Return what must vanish for a point to be an equilibrium."""
    zeros = [condition.expression for condition in point.conditions if condition.operator == "=="]
    return zeros if point.within is None else [*zeros, point.within.equation]


def _ends(within: Enclosure) -> tuple[tuple[Scalar, str], tuple[Scalar, str]]:
    """Return short numbers around an enclosure, and the signs there of what is 0 inside, whose slope does not vanish."""
    places, slope = len(str(int(abs(within.low)))), derivative(within.equation.numerator, within.name)
    for digits in range(1, _DIGITS):
        unit = Fraction(10) ** (places - digits)
        low, high = floor(within.low / unit) * unit, ceil(within.high / unit) * unit
        if sign_on(slope, within.name, (low, high)):
            break
    else:
        low, high = within.interval
    values = (within.equation.substitute({within.name: Scalar.of(end)}) for end in (low, high))
    first, second = ((Scalar.of(end), sign_of_number(each)) for end, each in zip((low, high), values, strict=True))
    return first, second


def _at(term: Term, values: Mapping[str, Scalar]) -> Term:
    """Return a term at values of names."""
    for name, value in values.items():
        term = term.at(name, value)
    return term


@contextmanager
def _where(page: Builder, point: Equilibrium) -> Iterator[None]:
    """Tell what follows as the case of the conditions of a point."""
    cases = [relation(c.expression, _STRICT[c.operator], 0) for c in point.conditions if c.operator in _STRICT]
    steps, environment = page.steps, page.environment
    page.steps = []
    for case in cases:
        page.environment = on_stratum(case, {}, page.environment)
    try:
        yield
    finally:
        inside, page.steps, page.environment = tuple(page.steps), steps, environment
        for case in reversed(cases):
            inside = (CaseStep(case, (), inside),)
        page.steps += inside


def _simple(value: Scalar) -> Scalar:
    return without_squares(simplified(value))


def _text(point: Equilibrium) -> str:
    return ", ".join(f"{name} = {value}" for name, value in point.values.items())


def known_of(given: Nonlinear) -> dict[str, Scalar]:
    """Return the values of inputs that were given with the plant."""
    return dict(given.held)


def nonlinear_of(plant: StateSpace) -> Nonlinear:
    """Return the nonlinear plant, or ẋ = A x of a linear one without input."""
    if plant.nonlinear is not None:
        return plant.nonlinear
    names = tuple(f"x_{k}" for k in range(1, plant.order + 1))
    f = plant.matrices.A @ Matrix.column([Scalar.symbol(name) for name in names])
    return Nonlinear(f, None, names, (), ())


@method("equilibria/elimination", source="definition")
def elimination(plant: StateSpace) -> Equilibria:
    """Solve f = 0 by factors, linear unknowns, and inverse functions, each step an equivalence."""
    given = nonlinear_of(plant)
    signs = {**plant.symbols.signs, **{name: plant.symbols.sign(name) for name in given.states + given.inputs}}
    known = {**{n: Scalar.of(0) for n in given.states if is_rate(n, given)}, **known_of(given)}
    found = all_equilibria(given, known, signs, is_discrete=plant.is_discrete)
    return Equilibria(plant, "elimination", {"found": found})


@task
def equilibria(plant: StateSpace, *, method: Name = "auto") -> Result:
    """Return all x, u with f(x, u) = 0 (f(x, u) = x in discrete time), and whether the linearisation at each is stable.

    plant    a nonlinear plant with n states, by f or by its equations of motion; values of its inputs count as given, and
             of a linear plant the input is 0
    Returns points (a mapping from states and inputs to values; what is free keeps its name), conditions (those of each
    point), stable and stable_if (of each linearisation), complete (whether there are no others).  Raises `InputError` for
    an unknown method.
    Source: H. K. Khalil, Nonlinear Systems, 3rd edition, sections 1.2 and 4.3.
    """
    return choose("equilibria", method, "elimination").solve(plant)
