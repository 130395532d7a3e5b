"""Results: answers that cannot exist unless their claims hold (trusted).

The constructor checks the claims, and they belong to the result's type, not to the method.
"""

from __future__ import annotations

from dataclasses import field, replace
from dataclasses import fields as parts_of
from functools import cache, cached_property, partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, NoReturn, Self, TypeAlias, Unpack, overload

from symobs.exact import Matrix, Scalar, TooLarge
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.formula.convention import STANDARD
from symobs.formula.tree import Environment
from symobs.formula.tree.written import written_relation
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, DerivationRejected, Undecided
from symobs.proof.certificate.claims import BEYOND_LIMITS, UNREADABLE, Certificate, Claim, Statement, check_all
from symobs.proof.derivation import translated
from symobs.proof.derivation.builder import Builder, relation, without_failing_cases
from symobs.system.conditions import Condition, joined, nonzero, vanishing_factors
from symobs.tasks.result.output_methods import PLAIN, WebPage, detail_of, document_options, to_sympy
from symobs.tasks.result.task_traits import TaskTraits
from symobs.tasks.result.writers import render, writer_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from pathlib import Path

    from symobs.formula.convention import Convention
    from symobs.formula.figures import Picture
    from symobs.proof.derivation import Derivation
    from symobs.proof.derivation.builder import Member
    from symobs.system import StateSpace
    from symobs.tasks.result.control_systems import Controller
    from symobs.tasks.result.output_methods import PageOptions


#: The formats that are texts.
Text: TypeAlias = Literal["fragment", "html", "html_fragment", "json", "latex", "markdown", "text", "numpy", "csv"]
#: The formats that are programs.
Code: TypeAlias = Literal["c", "matlab", "modelica", "python"]


def equality(left: Member, right: Member, environment: Environment, says: str = "") -> Claim:
    """Return the claim that two members are equal."""
    return Claim(relation(left, right), environment, says)


def holds(environment: Environment, text: str, says: str = "", **slots: Any) -> Claim:
    """Return the claim that a relation written as text holds; `says` are words before it."""
    return Claim(written_relation(text, environment, **slots), environment, says)


@dataclass
class Case:
    """A case: the relations that describe a stratum, and the complete result there (None: undecided)."""

    when: tuple[Condition, ...]
    substitution: Mapping[str, Scalar]
    result: Result | None


class Stratum(NamedTuple):
    """A case as a Python user meets it: SymPy relations, and the result where they hold (None: undecided)."""

    when: tuple[Any, ...]
    result: Any  # a `Result` of the same task or None, as the verdict says


@dataclass(eq=False, repr=False)
class Result(TaskTraits):
    """An answer with its certificates.  Subclasses own the claims; tampering with an answer makes construction fail."""

    plant: StateSpace
    method: str
    answer: Mapping[str, Any]
    certificates: tuple[Certificate, ...] = field(init=False)
    #: The method whose page is asked for; `auto` leaves the page free to be the most readable one.
    page_method: str = field(default="auto", kw_only=True)
    #: What the task was asked for beside the plant, as it was given.
    specification: Mapping[str, Any] = field(default_factory=dict, kw_only=True, compare=False)

    task: ClassVar[str]
    #: Whether the answers are functions of time, or of a horizon.
    in_time: ClassVar[bool] = False

    @property
    def argument(self) -> str:
        """What answers are functions of: t or k where they are functions of time, else the variable of polynomials."""
        in_time = "k" if self.plant.is_discrete else "t"
        return in_time if self.in_time else self.plant.variable

    def __post_init__(self) -> None:
        """Check every claim; raises `CertificateRejected`."""
        object.__setattr__(self, "answer", MappingProxyType(dict(self.answer)))
        try:
            object.__setattr__(self, "certificates", check_all(self.claims(), self.plant.relations))
        except BEYOND_LIMITS as error:
            raise Undecided(f"{self.task} is undecided, its answer cannot be checked: {error}") from error
        except UNREADABLE as error:
            raise CertificateRejected(f"the answer of {self.task} is no answer: {error}") from error

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the constructor arguments; unpickling checks all claims again."""
        made = {name: getattr(self, name) for name in _made_of(type(self))}  # type: ignore[arg-type]
        return (partial(type(self), **made | {"answer": dict(self.answer)}), ())

    def __eq__(self, other: object) -> bool:
        """Compare the constructor arguments: plant, method, answers, and the page's method and specification."""
        if type(other) is not type(self):
            return NotImplemented
        return all(getattr(self, name) == getattr(other, name) for name in _made_of(type(self), compared=True))  # type: ignore[arg-type]

    def __hash__(self) -> int:
        return hash((type(self), self.plant, self.method, self.page_method, tuple(self.answer)))

    def __bool__(self) -> NoReturn:
        raise TypeError(f"a result is neither true nor false; ask for its verdict: {self.task}(...).verdict == 'yes'")

    # -- what a subclass says ----------------------------------------------------------------------------------------

    def claims(self) -> Iterator[Claim | Statement]:
        """Yield what must hold."""
        raise NotImplementedError

    def write(self, page: Builder) -> None:
        """Write the derivation: by default as the page registered for this type does."""
        writer_of(type(self))(page, self)

    @property
    def verdict(self) -> str:
        """`yes`, `no`, `conditional` or `undecided`."""
        return "conditional" if self._binding_conditions else "yes"

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """The values whose vanishing costs existence: determinants of 𝒪, 𝒞."""
        return ()

    @property
    def free_signals(self) -> Mapping[str, int]:
        """The signals besides x, x̂ and u that the page starts with, and their sizes."""
        return {}

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The answers in the order of the JSON object; further ones may be derived from the first."""
        return self.answer

    @property
    def asked_fields(self) -> Mapping[str, Any]:
        """The fields without those that only follow from them and take long."""
        return self.fields

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of this result and of those it is made of."""
        return self.certificates

    @property
    def has_reduced_observer(self) -> bool:
        """Whether an observer of reduced order is part of it, which some conventions write in letters of their own."""
        return False

    @property
    def is_told_in_decimals(self) -> bool:
        """Whether answers are numbers without a closed form, which a page writes in decimals."""
        return False

    @property
    def picture(self) -> Picture | None:
        """The picture of the answer that the page shows, where there is one."""
        return None

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """What is true where a condition of existence fails."""
        return ()

    def meanings(self, **further: Any) -> Environment:
        """Return the environment of the claims: the plant, the answers that have a value, and further letters."""
        values = {name: getattr(self.plant.matrices, name) for name in "ABCD"} | {**self.answer, **further}
        found = {name: value for name, value in values.items() if isinstance(value, (Matrix, Scalar))}
        return Environment(variable=self.plant.variable, values=found, signs=self.plant.symbols.signs)

    # -- conditions ----------------------------------------------------------------------------------------------------

    @property
    def further_data(self) -> tuple[Matrix, ...]:
        """The matrices that are given beside the plant."""
        return ()

    @cached_property
    def domain(self) -> tuple[Condition, ...]:
        """What must not vanish for there to be a plant and further data: what they divide by."""
        m = self.plant.matrices
        divisors = [*_denominators([m.A, m.B, m.C, m.D]), *self.plant.apart]
        divisors += [] if self.plant.is_stratum else self.plant.nonzero
        divisors += _denominators(self.further_data)
        return (*nonzero("domain", vanishing_factors(divisors, self.plant.symbols.signs)), *self.plant.exists_where)

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The exact conditions under which the answer holds, without those implied by the declared signs."""
        factors = vanishing_factors(_denominators(self.answer.values()), self.plant.symbols.signs)
        return joined(self.domain, nonzero("claim", (f for f in factors if self.plant.variable not in f.names)))

    @property
    def conditions(self) -> tuple[Any, ...]:
        """The conditions of the answer as SymPy relations."""
        found: tuple[Any, ...] = to_sympy(self.holds_where, self.plant.symbols.objects)
        return found

    @property
    def cases(self) -> tuple[Stratum, ...]:
        """What is true where a condition of existence fails, with SymPy relations."""
        objects = self.plant.symbols.objects
        return tuple(Stratum(to_sympy(case.when, objects), case.result) for case in self.case_tree)

    @property
    def _binding_conditions(self) -> tuple[Condition, ...]:
        """The conditions that make a verdict conditional: all but those of the domain."""
        return tuple(condition for condition in self.holds_where if condition.kind != "domain")

    def with_answer(self, name: str, value: object) -> Self:
        """Return the same result with one answer replaced; raises `CertificateRejected` unless it holds too."""
        return replace(self, answer={**self.answer, name: value})

    def asked(self, method_name: str) -> Self:
        """Return the same result with the page of a method; its claims are independent of the page."""
        other = self._copied(page_method=method_name)
        other.__dict__.pop("derivation", None)
        return other

    @property
    def printed_method(self) -> str:
        """The method whose page is written."""
        return self.method if self.page_method == "auto" else self.page_method

    def specified(self, specification: Mapping[str, Any]) -> Self:
        """Return the same result with its specification; its claims are independent of it."""
        return self._copied(specification=specification)

    def in_place_of(self, other: Result) -> Self:
        """Return the same result with the page and the specification of another."""
        return self._copied(page_method=other.page_method, specification=other.specification)

    def _copied(self, **changed: Any) -> Self:
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__, **changed)
        return other

    # -- faces ---------------------------------------------------------------------------------------------------------

    @cached_property
    def derivation(self) -> Derivation:
        """The derivation, written and checked at first use."""
        page = Builder(self.plant, self.free_signals)
        page.asked_for(self.specification)
        self.write(page)
        written = page.derivation()
        try:
            established = written.check()
        except (DerivationRejected, TooLarge):
            written = without_failing_cases(written)
            established = written.check()
        for name, value in self.data.items():
            if name in established.values and established.values[name] != value:
                raise DerivationRejected(f"the page speaks of another {name}", line=name)
        return written

    @property
    def data(self) -> Mapping[str, Scalar | Matrix]:
        """What the letters of the data must mean on the page: the plant's matrices."""
        m = self.plant.matrices
        return {"A": m.A, "B": m.B, "C": m.C, "D": m.D}

    @property
    def systems(self) -> Mapping[str, Realisation]:
        """The systems of a design by name: the plant, if it has input and output, and the designed systems."""
        m = self.plant.matrices
        return {"plant": Realisation(m.A, m.B, m.C, m.D)} if m.has_input and m.has_output else {}

    @property
    def controller(self) -> Controller | None:
        """The system of a design that a program runs."""
        return None

    @overload
    def to(self, format_name: Literal["pdf"], **page: Unpack[PageOptions]) -> bytes: ...
    @overload
    def to(self, format_name: Text, **page: Unpack[PageOptions]) -> str: ...
    @overload
    def to(self, format_name: Code, *, period: object = None, hold: Literal["zoh", "tustin"] = "zoh") -> str: ...
    @overload
    def to(
        self, format_name: str, *, period: object = None, hold: str = "zoh", **page: Unpack[PageOptions]
    ) -> str | bytes: ...
    def to(
        self, format_name: str, *, period: object = None, hold: str = "zoh", **page: Unpack[PageOptions]
    ) -> str | bytes:
        """Return the result in a format: latex, html, text, json, pdf, …; in a convention, by name or TOML file.

        `detail` says how much of the derivation is told: full, outline or answer; `references` how the literature is: none,
        short or full; `language` is en or de.  Data typed as
        decimals make a page of decimals; `digits` asks for so many significant ones, `exact` for none.  python, matlab, c
        and modelica are the observer or compensator as a program, sampled with a `period` such as "1/100" by a zero-order
        hold (zoh) or by the bilinear map (tustin); numpy and csv the numbers alone.
        """
        page.setdefault("detail", detail_of(format_name))
        asked = document_options(**page)
        return render(Document("", "", (self,), period=period, hold=hold, **asked), format_name)


@cache
def _made_of(kind: type[Result], *, compared: bool = False) -> tuple[str, ...]:
    """Return the constructor arguments of a result; for comparison, without those that only save time."""
    return tuple(part.name for part in parts_of(kind) if part.init and (part.compare or not compared))


def _denominators(values: Iterable[Any]) -> list[Scalar]:
    """Return the denominators of scalars and matrices."""
    return [value.common_denominator() for value in values if hasattr(value, "common_denominator")]


@dataclass
class Document:
    """The input of a format: title, source, results, the problem in words, and the options of the page."""

    title: str
    source: str
    results: tuple[Result, ...]
    convention: Convention = STANDARD
    text: str = ""
    detail: str = field(default="full", kw_only=True)
    #: How the literature is told below the page: not at all, on a line each, or in full.
    references: str = field(default="short", kw_only=True)
    #: The code of the language of the page.
    language: str = field(default="en", kw_only=True)
    templates: Path | None = field(default=None, kw_only=True)
    #: For a format that is a program: the sampling period, and how the input is held.
    period: object = field(default=None, kw_only=True)
    hold: str = field(default="zoh", kw_only=True)
    #: The answers that are printed alone, by name; none means the whole document.
    printed: tuple[str, ...] = field(default=(), kw_only=True)
    #: The significant digits of the numbers on a page: 0 writes them exactly, None does as the data are typed.
    digits: int | None = field(default=None, kw_only=True)
    #: What a sheet adds to each part of a question, points in words and room for an answer; or the points of a solution.
    handout: tuple[Any, ...] = field(default=(), kw_only=True)
    is_below: bool = field(default=False, kw_only=True)  #: below its question, which says what is given
    #: What a page of HTML offers besides its text.
    web: WebPage = field(default=PLAIN, kw_only=True)

    @property
    def letters_asked(self) -> frozenset[str]:
        """The letters of answers that are asked for and stand in no derivation: a question says what they mean."""
        return frozenset()

    @cached_property
    def derivations(self) -> tuple[Derivation, ...]:
        """The checked derivations of the results, in the signs of the convention."""
        return tuple(translated(result.derivation, self.convention) for result in self.results)
