"""Results, and the registries of tasks, methods and formats (trusted).

A `Result` cannot exist unless its claims hold: the constructor checks them, and they belong to the result's type, not to
the method.  Tasks, methods and formats register themselves by decorators in modules that are discovered.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from dataclasses import fields as parts_of
from functools import cached_property, wraps
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self, TypeVar, get_args

import symobs
from symobs.certificate import SENSELESS, Certificate, Claim, Statement, check_all
from symobs.conditions import Condition, vanishing_factors
from symobs.errors import CertificateRejected, DerivationRejected, InputError, UsageError
from symobs.page import Page

if TYPE_CHECKING:
    from pathlib import Path

    from symobs.derivation import Derivation
    from symobs.exact import Matrix, Scalar
    from symobs.picture import Picture
    from symobs.system import StateSpace

Kind = TypeVar("Kind", bound=type)
Callback = TypeVar("Callback", bound=Callable[..., Any])


@dataclass(frozen=True)
class Case:
    """What is true on a stratum: the relations that describe it, and the full result there (None: undecided)."""

    when: tuple[Condition, ...]
    substitution: Mapping[str, Scalar]
    result: Result | None


class Stratum(NamedTuple):
    """A case as a Python user meets it: SymPy relations, and the result where they hold (None: undecided)."""

    when: tuple[Any, ...]
    result: Result | None


@dataclass(frozen=True, eq=False)
class Result:
    """An answer with its certificates.  Subclasses own the claims; tampering with an answer makes construction fail."""

    plant: StateSpace
    method: str
    answer: Mapping[str, Any]
    certificates: tuple[Certificate, ...] = field(init=False)

    task: ClassVar[str]
    page_method = "auto"
    #: Whether the answers are functions of time, or of a horizon.
    in_time: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Check every claim; raises `CertificateRejected`."""
        object.__setattr__(self, "answer", MappingProxyType(dict(self.answer)))
        try:
            object.__setattr__(self, "certificates", check_all(self.claims(), self.plant.relations))
        except SENSELESS as error:
            message = f"the answer of {self.task} is no answer: {error}"
            raise CertificateRejected(message, repair="please report this: it is a bug of symobs") from error

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle what the result was made of: whoever reads it back checks the claims again."""
        made = [dict(self.answer) if f.name == "answer" else getattr(self, f.name) for f in parts_of(self) if f.init]
        return (type(self), tuple(made), {"page_method": self.page_method})

    # -- what a subclass says ----------------------------------------------------------------------------------------

    def claims(self) -> Iterator[Claim | Statement]:
        """Yield what must hold."""
        raise NotImplementedError

    def write(self, page: Page) -> None:
        """Write the derivation."""
        raise NotImplementedError

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
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of this result and of those it is made of."""
        return self.certificates

    @property
    def picture(self) -> Picture | None:
        """The picture of the answer that the page shows, where there is one."""
        return None

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """What is true where a condition of existence fails."""
        return ()

    # -- conditions ----------------------------------------------------------------------------------------------------

    @cached_property
    def domain(self) -> tuple[Condition, ...]:
        """What must not vanish for there to be a plant: the denominators of its entries."""
        m = self.plant.matrices
        factors = vanishing_factors(_denominators([m.A, m.B, m.C, m.D]), self.plant.symbols.signs)
        return tuple(Condition("domain", factor) for factor in factors)

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The exact conditions under which the answer holds, what the declared signs imply left out."""
        known = {condition.expression for condition in self.domain}
        factors = vanishing_factors(_denominators(self.answer.values()), self.plant.symbols.signs)
        new = [factor for factor in factors if factor not in known and self.plant.variable not in factor.names]
        return (*self.domain, *(Condition("claim", factor) for factor in new))

    @property
    def _binding_conditions(self) -> tuple[Condition, ...]:
        """The conditions that make a verdict conditional: all but those of the domain."""
        return tuple(condition for condition in self.holds_where if condition.kind != "domain")

    def with_answer(self, name: str, value: object) -> Self:
        """Return the same result with one answer replaced; raises `CertificateRejected` unless it holds too."""
        return replace(self, answer={**self.answer, name: value})

    def asked(self, method_name: str) -> Self:
        """Keep the method name that was asked for; `auto` leaves the page free to be the most readable one."""
        object.__setattr__(self, "page_method", method_name)
        return self

    # -- faces ---------------------------------------------------------------------------------------------------------

    @cached_property
    def derivation(self) -> Derivation:
        """The derivation, written and checked when first asked for."""
        page = Page(self.plant, self.free_signals)
        self.write(page)
        written = page.derivation()
        established = written.check()
        for name, value in self.data.items():
            if name in established.values and established.values[name] != value:
                message = f"the page speaks of another {name}"
                raise DerivationRejected(message, repair="please report this: it is a bug of symobs", line=name)
        return written

    @property
    def data(self) -> Mapping[str, Scalar | Matrix]:
        """What the letters of the data must mean on the page: the plant's matrices."""
        m = self.plant.matrices
        return {"A": m.A, "B": m.B, "C": m.C, "D": m.D}

    def __getattr__(self, name: str) -> Any:
        """Return an answer as SymPy objects."""
        from symobs.face import to_sympy  # noqa: PLC0415 - SymPy is the face only

        objects = {} if name.startswith("_") else self.plant.symbols.objects
        if name == "conditions":
            return to_sympy(self.holds_where, objects)
        if name == "cases":
            return tuple(Stratum(to_sympy(case.when, objects), case.result) for case in self.case_tree)
        if name.startswith("_") or name == "fields" or name not in self.fields:
            message = f"{type(self).__name__} has no attribute {name!r}"
            raise AttributeError(message)
        return to_sympy(self.fields[name], objects)

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), "conditions", "cases", *self.fields]

    def to(self, format_name: str, *, detail: str = "full") -> str | bytes:
        """Return the result in a format: latex, text, json, …; `detail` is full, outline or answer."""
        return render(Document("", "", (self,), detail=detail), format_name)

    def to_latex(self) -> str:
        """Return the derivation as a LaTeX article."""
        return str(self.to("latex"))

    def to_json(self) -> str:
        """Return the result as JSON."""
        return str(self.to("json"))

    def _repr_latex_(self) -> str:
        return str(self.to("fragment"))

    def _repr_mimebundle_(self, **_: Any) -> dict[str, str]:
        return {"text/plain": str(self.to("text")), "text/latex": self._repr_latex_()}

    def __repr__(self) -> str:
        shown = [f"{name}={value}" for name, value in self.answer.items() if value is not None]
        return f"{type(self).__name__}({', '.join(shown)[:200]}, verdict={self.verdict!r})"


def _denominators(values: Iterable[Any]) -> list[Scalar]:
    """Return the denominators of scalars and matrices."""
    return [value.common_denominator() for value in values if hasattr(value, "common_denominator")]


# -- registries --------------------------------------------------------------------------------


@dataclass(frozen=True)
class Method:
    """One way to meet a result type's claim: `solve` returns the result, `write` its page."""

    task: str
    name: str
    source: str
    solve: Callable[..., Result]
    summary: str


@dataclass(frozen=True)
class Task:
    """A question one can ask: its function, its keywords with their kinds; `alone` where it needs no plant."""

    name: str
    function: Callable[..., Result]
    keywords: Mapping[str, str]
    summary: str
    alone: bool = False


@dataclass(frozen=True)
class Document:
    """What a format renders: a title, its source, results, how much of them is told, and the user's own templates."""

    title: str
    source: str
    results: tuple[Result, ...]
    detail: str = field(default="full", kw_only=True)
    templates: Path | None = field(default=None, kw_only=True)

    @property
    def derivations(self) -> tuple[Derivation, ...]:
        """The checked derivations of the results."""
        return tuple(result.derivation for result in self.results)


_TASKS: dict[str, Task] = {}
_IN_TIME: list[str] = []
_METHODS: dict[str, Method] = {}
_FORMATS: dict[str, Any] = {}
_DISCOVERED: set[str] = set()


def task(function: Callback) -> Callback:
    """Register a task for plants with constant matrices; its keywords are its specification."""
    return _registered(_of_constant_plants(function))


def task_in_time(function: Callback) -> Callback:
    """Register a task that takes time-varying plants as well."""
    _IN_TIME.append(function.__name__)
    return _registered(function)


def _of_constant_plants(function: Callback) -> Callback:
    """Refuse a plant whose matrices contain the time t, naming the tasks that take it."""

    @wraps(function)
    def refusing(plant: StateSpace, *arguments: Any, **keywords: Any) -> Result:
        if getattr(plant, "is_time_varying", False):  # a text is no plant
            message = f"{function.__name__} is for plants with constant matrices, and this plant depends on the time t"
            tasks()
            repair = f"use {' or '.join(_IN_TIME)}, or give a constant that is called t another name"
            raise InputError(message, where="plant", repair=repair)
        result: Result = function(plant, *arguments, **keywords)
        return result

    return refusing  # type: ignore[return-value]


def _registered(function: Callback) -> Callback:
    """Register a task; its keyword-only parameters are its specification, their annotations the kinds."""
    signature = inspect.signature(function).parameters
    keywords = {n: _kind(p.annotation) for n, p in signature.items() if p.kind is inspect.Parameter.KEYWORD_ONLY}
    alone = signature["plant"].default is None
    _TASKS[function.__name__] = Task(function.__name__, function, keywords, _summary(function), alone)
    return function


def _kind(annotation: Any) -> str:
    """Return the name of a kind: of the text `Poles | None` as of the types themselves."""
    if isinstance(annotation, str):
        return annotation.split(" ")[0]
    kinds = getattr(annotation, "__metadata__", None)
    return str(kinds[0]) if kinds else _kind(get_args(annotation)[0])


def method(name: str, *, source: str) -> Callable[[Callback], Callback]:
    """Register a method under `task/name`."""

    def register(function: Callback) -> Callback:
        of, _, short = name.partition("/")
        _METHODS[name] = Method(of, short, source, function, _summary(function))
        return function

    return register


def output_format(kind: Kind) -> Kind:
    """Register an output format: a class with `name`, `suffix` and `render(document)`."""
    _FORMATS[kind.name] = kind()  # type: ignore[attr-defined]
    return kind


def _summary(function: Callable[..., Any]) -> str:
    return (inspect.getdoc(function) or "").partition("\n")[0]


def _discover(package: str) -> None:
    """Import every module of a package, once."""
    if package not in _DISCOVERED:
        _DISCOVERED.add(package)
        for found in _modules(package):
            importlib.import_module(f"{package}.{found.name}")


def _modules(package: str) -> Iterator[pkgutil.ModuleInfo]:
    """Yield the modules of a package, without importing them."""
    yield from pkgutil.iter_modules(importlib.import_module(package).__path__)


def tasks() -> Mapping[str, Task]:
    """Return all tasks by name."""
    for package in symobs.TASK_PACKAGES:
        _discover(package)
    return _TASKS


def task_named(name: str) -> Task | None:
    """Return a task, None where there is none; a module of its name is looked at first: a run pays for what it needs."""
    if name not in _TASKS and name.isidentifier():
        for package in symobs.TASK_PACKAGES:
            if name in {found.name for found in _modules(package)}:
                importlib.import_module(f"{package}.{name}")
    return _TASKS.get(name) or tasks().get(name)


def methods(of: str | None = None) -> Mapping[str, Method]:
    """Return all methods, or those of one task, by `task/name`."""
    tasks()
    return {name: found for name, found in _METHODS.items() if of is None or found.task == of}


def choose(of: str, name: str, automatic: str) -> Method:
    """Return the method asked for; `auto` means `automatic`.  Raises `InputError` naming what exists."""
    wanted = f"{of}/{automatic if name == 'auto' else name}"
    if wanted not in _METHODS and wanted not in methods(of):
        message = f"{name[:40]!r} is not a method of {of}"
        existing = ", ".join(["auto", *(found.name for found in methods(of).values())])
        raise InputError(message, where="specification.method", repair=f"write one of {existing}")
    return _METHODS[wanted]


def formats() -> Mapping[str, Any]:
    """Return all output formats by name."""
    _discover(symobs.FORMAT_PACKAGE)
    return _FORMATS


def render(document: Document, format_name: str) -> str | bytes:
    """Return a document in a format; raises `UsageError` naming the formats that exist."""
    rendered: str | bytes = format_named(format_name).render(document)
    return rendered


def format_named(name: str) -> Any:
    """Return a format; a module of its name is looked at first. Raises `UsageError` naming those that exist."""
    if name.isidentifier() and name in {found.name for found in _modules(symobs.FORMAT_PACKAGE)}:
        importlib.import_module(f"{symobs.FORMAT_PACKAGE}.{name}")
    if name not in _FORMATS and name not in formats():
        message = f"{name[:40]!r} is not an output format"
        raise UsageError(message, repair=f"use one of {', '.join(sorted(_FORMATS))}")
    return _FORMATS[name]
