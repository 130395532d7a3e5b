"""What a result and the registries refuse, one check at a time: each fails where one check is left out or weaker."""

from __future__ import annotations

import pickle
from dataclasses import FrozenInstanceError, replace
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import pytest
import sympy

from symobs import StateSpace, compensator, observability, observer, reduced_order_observer, stability_region
from symobs.exact import Matrix, Scalar
from symobs.formula.convention import STANDARD, convention_named
from symobs.formula.tree import Environment, Letter
from symobs.ground.errors import CertificateRejected, DerivationRejected, InputError, UsageError
from symobs.proof.certificate.claims import Certificate, Claim, Statement
from symobs.proof.derivation import Define, Derivation
from symobs.tasks.result import (
    Case,
    Document,
    Method,
    Result,
    choose,
    format_named,
    formats,
    method,
    methods,
    output_format,
    registry,
    render,
    task,
    task_in_time,
    task_named,
    tasks,
    writers,
)
from tests.support.problems.steps import A, F, said

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from symobs.proof.derivation.builder import Builder

PLANT = StateSpace("[0 1; -k/m -2]", "[0; 1/m]", "[1 c]")
SERVO = StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]")


class Squared(Result):
    """The square of a number, which its page shows."""

    task: ClassVar[str] = "squared"

    def claims(self) -> Iterator[Claim | Statement]:
        yield Claim(said(self.answer["square"], self.answer["number"] ** 2), Environment(), "a square")
        yield Statement("shown", lambda: "by hand")

    def write(self, page: Builder) -> None:
        page.steps = [Define(said(F, self.answer["square"]))]


def squared(number: Scalar, square: Scalar, plant: StateSpace = SERVO) -> Squared:
    return Squared(plant, "by hand", {"number": number, "square": square})


# -- a result -----------------------------------------------------------------------------------------------------------


def test_a_result_holds_or_is_not() -> None:
    number = Scalar.of(3)
    found = squared(number, number * 3)
    assert found.certificates == (Certificate("a square", "exact", "0"), Certificate("shown", "by hand", "0"))
    assert found.all_certificates == found.certificates
    with pytest.raises(CertificateRejected, match="a square"):
        squared(number, number)
    with pytest.raises(CertificateRejected, match="the answer of squared is no answer") as caught:
        Squared(SERVO, "by hand", {"number": number})
    assert isinstance(caught.value.__cause__, LookupError)
    with pytest.raises(CertificateRejected, match="the claim a square"):
        found.with_answer("square", number)
    with pytest.raises(CertificateRejected, match="the answer of squared is no answer: 'square'"):
        replace(found, answer={})
    other = found.with_answer("number", -number)
    assert dict(other.answer) == {"number": -number, "square": Scalar.of(9)}
    assert type(other) is Squared


def test_a_result_cannot_be_changed() -> None:
    given = {"number": Scalar.of(3), "square": Scalar.of(9)}
    found = Squared(SERVO, "by hand", given)
    given["number"] = Scalar.of(4)
    assert found.answer["number"] == Scalar.of(3)
    with pytest.raises(TypeError):
        found.answer["number"] = Scalar.of(4)  # type: ignore[index]
    with pytest.raises(FrozenInstanceError):
        found.answer = given  # type: ignore[misc]
    with pytest.raises(FrozenInstanceError):
        Case((), {}, found).result = None  # type: ignore[misc]


def test_results_and_plants_compare_by_value() -> None:
    """Equal is what answers the same about the same plant; of a plant entries, time and signs count, not how it was written."""
    plants = [
        StateSpace("[0 1; -k/m -2]", "[0; 1/m]", "[1 c]"),
        StateSpace([[0, 1], ["-k/m", -2]], [[0], ["1/m"]], [[1, "c"]]),
        StateSpace(sympy.Matrix([[0, 1], [-sympy.Symbol("k") / sympy.Symbol("m"), -2]]), "[0; 1/m]", "[1 c]"),
    ]
    assert len({*plants, PLANT}) == 1
    designs = {observer(plant, poles=[-1, -2]) for plant in plants}
    assert len(designs) == 1
    (found,) = designs
    assert observability(plants[0]) == observability(plants[1])
    regions = [stability_region(polynomial="s^2 + k*s + 1", margin=margin) for margin in (None, None, 1)]
    assert len(set(regions)) == 2
    others = [
        StateSpace("[0 1; -k/m -2]", "[0; 1/m]", "[1 c]", symbols={"k": "positive", "m": "real", "c": "real"}),
        StateSpace("[0 1; -k/m -2]", "[0; 1/m]", "[1 c]", dt=True),
        StateSpace("[0 1; -k/m -2]", "[0; 1/m]", "[1 2*c]"),
        StateSpace("[0 1; -k/m -2]", C="[1 c]"),
    ]
    assert len({PLANT, *others}) == 5
    assert found not in [observer(plant, poles=[-1, -2]) for plant in others]
    assert found != observer(PLANT, poles=[-1, -3])
    assert found != observer(PLANT, poles=[-1, -2], method="existence")
    assert found != "a text"
    assert PLANT != "a text"


def test_a_result_is_neither_true_nor_false() -> None:
    with pytest.raises(TypeError, match=r"ask for its verdict: observability\(\.\.\.\)\.verdict == 'yes'"):
        bool(observability(SERVO))


@pytest.mark.parametrize(
    ("asked", "letter"),
    [
        (lambda: observer(SERVO, poles=[-1, -2], method="existence"), "L"),
        (lambda: compensator(SERVO, control_poles=[-1, -2], observer_poles=[-3, -4], method="duality"), "K"),
        (lambda: reduced_order_observer(SERVO, poles=[-1], method="undetermined"), "L"),
    ],
)
def test_another_answer_keeps_the_page_asked_for(asked: Callable[[], Result], letter: str) -> None:
    found = asked()
    other = found.with_answer(letter, found.answer[letter])
    assert other.page_method == replace(found).page_method == found.page_method != "auto"
    assert pickle.loads(pickle.dumps(other)).to_latex() == found.to_latex()  # noqa: S301 - our own bytes


def test_a_result_read_back_is_checked_again() -> None:
    found = squared(Scalar.of(3), Scalar.of(9)).asked("by head")
    read = pickle.loads(pickle.dumps(found))  # noqa: S301 - our own bytes
    assert (dict(read.answer), read.method, read.page_method) == (dict(found.answer), "by hand", "by head")
    assert read.certificates == found.certificates
    assert read == found
    assert found.asked("auto").page_method == "auto"
    assert found.page_method == "by head"
    made, _ = found.__reduce__()
    with pytest.raises(CertificateRejected, match="the claim a square"):
        made(answer={**found.answer, "square": Scalar.of(8)})


def test_the_relations_of_the_plant_hold_for_its_results() -> None:
    """On a stratum h = 1 the square of h is 1."""
    h = Scalar.symbol("h")
    with pytest.raises(CertificateRejected, match="the claim a square"):
        squared(h, Scalar.of(1))
    inside = StateSpace("[0 1; 0 -h]", "[0; 1]", "[1 0]").restricted([h - 1])
    assert squared(h, Scalar.of(1), inside).certificates[0].how == "exact"


# -- its page -----------------------------------------------------------------------------------------------------------


class Elsewhere(Squared):
    """A result whose page speaks of a matrix of its own."""

    letter: ClassVar[str] = "A"
    value: ClassVar[Any] = Matrix.identity(2)

    def write(self, page: Builder) -> None:
        page.steps = [Define(said(Letter(self.letter), self.value))]


@pytest.mark.parametrize("letter", ["A", "B", "C", "D"])
def test_a_page_speaks_of_the_plant_s_own_data(letter: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Elsewhere, "letter", letter)
    number = {"number": Scalar.of(3), "square": Scalar.of(9)}
    with pytest.raises(DerivationRejected, match=f"the page speaks of another {letter}") as caught:
        _ = Elsewhere(SERVO, "by hand", number).derivation
    assert caught.value.facts["line"] == letter
    own = getattr(SERVO.matrices, letter)
    monkeypatch.setattr(Elsewhere, "value", own)
    assert isinstance(Elsewhere(SERVO, "by hand", number).derivation, Derivation)


def test_a_page_is_checked() -> None:
    class Lying(Squared):
        def write(self, page: Builder) -> None:
            page.steps = [Define(said(F, A))]

    lying = Lying(SERVO, "by hand", {"number": Scalar.of(3), "square": Scalar.of(9)})
    with pytest.raises(DerivationRejected, match="before it is established"):
        _ = lying.derivation
    assert squared(Scalar.of(3), Scalar.of(9)).derivation.steps == (Define(said(F, 9)),)

    class Driven(Squared):
        free_signals = {"v": 1}  # noqa: RUF012 - a property there

        def write(self, page: Builder) -> None:
            page.steps = [Define(said(Letter("y"), Letter("v")))]

    assert Driven(SERVO, "m", {"number": Scalar.of(3), "square": Scalar.of(9)}).derivation.check().defines("y")


# -- conditions ---------------------------------------------------------------------------------------------------------


def test_conditions_are_those_of_plant_and_answer() -> None:
    k, m, c = (Scalar.symbol(name) for name in "kmc")
    found = squared(1 / c, 1 / c**2, PLANT)
    assert [(x.kind, x.expression) for x in found.domain] == [("domain", m)]
    assert [(x.kind, x.expression) for x in found.holds_where] == [("domain", m), ("claim", c)]
    assert found.verdict == "conditional"
    known = squared(1 / m, 1 / m**2, PLANT)
    assert [(x.kind, x.expression) for x in known.holds_where] == [("domain", m)]
    assert known.verdict == "yes"
    s = Scalar.symbol("s")
    assert squared(1 / (s + k), 1 / (s + k) ** 2, PLANT).verdict == "yes"
    declared = StateSpace("[0 1; -k/m -2]", "[0; 1/m]", "[1 c]", symbols={"k": "real", "m": "positive", "c": "nonzero"})
    assert squared(1 / c, 1 / c**2, declared).holds_where == ()
    for place in range(4):
        parts: list[Any] = [[["0"]], [["1"]], [["1"]], [["0"]]]
        parts[place] = [["1/c"]]
        assert [x.expression for x in squared(k, k * k, StateSpace(*parts)).domain] == [c]


def test_what_is_not_said_is_nothing() -> None:
    found = squared(Scalar.of(3), Scalar.of(9))
    assert (found.existence, found.free_signals, found.case_tree, found.picture) == ((), {}, (), None)
    assert (found.has_reduced_observer, found.in_time, dict(found.fields)) == (False, False, dict(found.answer))


# -- faces --------------------------------------------------------------------------------------------------------------


def test_answers_leave_as_sympy_objects() -> None:
    found = squared(Scalar.of(3), Scalar.of(9))
    assert (found.square, found.conditions, found.cases) == (sympy.Integer(9), (), ())
    for name in ("cube", "_private", "__deepcopy__"):
        with pytest.raises(AttributeError, match=f"Squared has no attribute '{name}'"):
            getattr(found, name)
    hidden = Squared(SERVO, "by hand", {"number": Scalar.of(3), "square": Scalar.of(9), "_own": Scalar.of(1)})
    with pytest.raises(AttributeError):
        _ = hidden._own
    x = sympy.Symbol("x", positive=True)
    own = observer(StateSpace([[0, 1], [0, -x]], C=[[1, 0]]), poles=[-1, -2])
    assert own.L.free_symbols == {x}
    case = observability(PLANT)
    assert [stratum.result for stratum in case.cases] == [inner.result for inner in case.case_tree]
    for stratum, inner in zip(case.cases, case.case_tree, strict=True):
        assert len(stratum.when) == len(inner.when) > 0
        assert all(isinstance(when, sympy.Basic) for when in stratum.when)
    with pytest.raises(AttributeError, match="has no attribute '_own'"):
        _ = object.__new__(Squared)._own

    class Fieldless(Squared):
        @property
        def fields(self) -> Any:
            raise AttributeError(f"what failed inside of {self.answer['number']}")

    class Inheriting(Fieldless):
        pass

    for kind in (Fieldless, Inheriting):
        with pytest.raises(AttributeError, match="what failed inside of 3"):  # not that there are no fields
            _ = kind(SERVO, "m", dict(found.answer)).fields
    assert {"square", "conditions", "cases", "to", "derivation"} <= set(dir(found))


def test_a_result_is_shown_short() -> None:
    found = Squared(SERVO, "m", {"number": Scalar.of(3), "square": Scalar.of(9), "none": None})
    assert repr(found) == "Squared(number=3, square=9, verdict='yes')"
    long = squared(Scalar.of(10**150), Scalar.of(10**300))
    assert len(repr(long)) == len("Squared(, verdict='yes')") + 200


def test_a_document_is_told_in_its_convention() -> None:
    found = observer(SERVO, poles=[-10, -10])
    document = Document("", "", (found,))
    assert (document.convention, document.text, document.detail, document.templates) == (STANDARD, "", "full", None)
    assert document.derivations == (found.derivation,)
    for place in ("full", None):
        with pytest.raises(TypeError):
            Document("", "", (found,), STANDARD, "", place)  # type: ignore[call-arg, arg-type]
    other = replace(document, convention=convention_named("S1"))
    (derivation,) = other.derivations
    L = found.answer["L"]
    assert derivation.check().values["L"] == -L
    assert found.derivation.check().values["L"] == L
    told: list[Any] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("symobs.tasks.result.result.render", lambda *asked: told.append(asked))
        found.to("text", convention="S1", detail="outline")
    assert told == [(Document("", "", (found,), convention_named("S1"), detail="outline"), "text")]
    assert found.to("latex", convention="S1") != found.to("latex") == found.to("latex", detail="full")
    assert len(found.to("latex", detail="answer")) < len(found.to("latex"))
    with pytest.raises(FrozenInstanceError):
        document.title = "other"  # type: ignore[misc]
    with pytest.raises(TypeError):
        Document("", "", (found,), STANDARD, "", "full")  # type: ignore[call-arg]


# -- registries ---------------------------------------------------------------------------------------------------------


@pytest.fixture
def empty(monkeypatch: pytest.MonkeyPatch) -> None:
    """Take what is registered away again."""
    tasks(), formats()
    for name, copy in (("_TASKS", dict), ("_METHODS", dict), ("_FORMATS", dict), ("_IN_TIME", list)):
        owner = registry if hasattr(registry, name) else writers
        monkeypatch.setattr(owner, name, copy(getattr(owner, name)))


class Answer:
    """What a task made for a test returns: the arguments it was called with."""

    def __init__(self, *given: Any) -> None:
        self.given = given
        self.asked: dict[str, Any] = {}

    def specified(self, asked: dict[str, Any]) -> Answer:
        self.asked = asked
        return self


@pytest.mark.usefixtures("empty")
def test_a_task_is_its_signature() -> None:

    def weigh(plant: Any, *, poles: Any = None, of: Any = "") -> Any:
        """Weigh a plant.

        More of it.
        """
        return Answer(plant, poles, of)

    def works_without_plant(plant: Any = None, first: Any = None, *, number: Any = None) -> Any:
        return Answer(plant, first, number)

    weigh.__annotations__ |= {"poles": "Poles | None", "of": Annotated[str, "Of"]}
    works_without_plant.__annotations__["number"] = Annotated[int, "Number"] | None
    weighed = task(weigh)(SERVO, of="x")
    assert (weighed.given, weighed.asked) == ((SERVO, None, "x"), {"of": "x"})
    found = tasks()["weigh"]
    assert (found.name, dict(found.keywords), found.summary) == (
        "weigh",
        {"poles": "Poles", "of": "Of"},
        "Weigh a plant.",
    )
    assert found.works_without_plant is False
    assert task_in_time(works_without_plant)(number=3).given == (None, None, 3)
    found = tasks()["works_without_plant"]
    assert (found.works_without_plant, dict(found.keywords), found.summary) == (True, {"number": "Number"}, "")
    with pytest.raises(FrozenInstanceError):
        found.name = "other"  # type: ignore[misc]
    assert registry._kind(Annotated[str, "Of"] | None) == "Of"


@pytest.mark.usefixtures("empty")
def test_plants_in_time_are_refused_where_matrices_are_constant() -> None:
    varying = StateSpace("[0 t; 0 0]", C="[1 0]")
    with pytest.raises(InputError, match="observer is for plants with constant matrices") as caught:
        observer(varying, poles=[-1, -2])
    assert caught.value.where == "plant"
    assert "time_varying_observability" in caught.value.repair

    def constant(plant: Any) -> Any:
        return plant

    refusing = task(constant)
    with pytest.raises(InputError, match="a plant is expected, but a value of type str came"):
        refusing("a text")
    with pytest.raises(InputError, match="constant is for plants with constant matrices"):
        refusing(varying)
    assert refusing.__name__ == "constant"


@pytest.mark.usefixtures("empty")
def test_methods_are_found_by_their_task() -> None:
    @method("observer/guess", source="nowhere")
    def guess() -> Any:
        """Guess it."""

    found = methods("observer")
    assert set(found) == {name for name in methods() if name.startswith("observer/")}
    assert found["observer/guess"] == Method("observer", "guess", "nowhere", guess, "Guess it.")
    assert choose("observer", "guess", "ackermann").solve is guess
    assert choose("observer", "auto", "guess").solve is guess
    assert choose("observer", "auto", "ackermann").name == "ackermann"
    with pytest.raises(InputError, match="'luck' is not a method of observer") as caught:
        choose("observer", "luck", "ackermann")
    assert caught.value.where == "specification.method"
    assert caught.value.repair.startswith("write one of auto, ")
    assert "guess" in caught.value.repair
    with pytest.raises(InputError, match=f"'{'x' * 40}' is not"):
        choose("observer", "x" * 50, "ackermann")
    with pytest.raises(FrozenInstanceError):
        found["observer/guess"].name = "other"  # type: ignore[misc]


@pytest.mark.usefixtures("empty")
def test_tasks_are_found_by_name() -> None:
    assert task_named("observer") is tasks()["observer"]
    for name in ("nothing", "no name", "../observer", ""):
        assert task_named(name) is None
    assert task_named("stabilizability") is tasks()["stabilizability"]


@pytest.mark.usefixtures("empty")
def test_formats_are_found_by_name() -> None:
    @output_format
    class Silent:
        name = "silent"
        suffix = ".nothing"

        def render(self, document: Document) -> str:
            return f"<{document.title}>"

    assert formats()["silent"] is format_named("silent")
    assert render(Document("title", "", ()), "silent") == "<title>"
    assert {"latex", "text", "json", "html", "markdown"} <= set(formats())
    assert format_named("json") is formats()["json"]
    with pytest.raises(UsageError, match="'word' is not an output format") as caught:
        format_named("word")
    assert "html" in caught.value.repair
    for name in ("no name", "x" * 50):
        with pytest.raises(UsageError, match=f"'{name[:40]}' is not"):
            render(Document("", "", ()), name)


def test_only_what_is_asked_for_is_imported(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a package every module is imported once, and a single one by its name."""
    imported: list[str] = []
    monkeypatch.setattr("importlib.import_module", imported.append)
    monkeypatch.setattr(writers, "_DISCOVERED", set())
    modules = ("symobs.tasks.design.full_order.observer",)
    monkeypatch.setattr(writers, "_modules", lambda package: modules if package.endswith("design") else ())
    monkeypatch.setattr(registry, "_TASKS", {})
    assert task_named("observer") is None
    assert imported[0] == "symobs.tasks.design.full_order.observer"
    imported.clear()
    writers.discover("symobs.tasks.design")
    writers.discover("symobs.tasks.design")
    assert imported in ([], ["symobs.tasks.design.full_order.observer"])
