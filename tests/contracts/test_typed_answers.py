"""The answer of a task is typed: it has the keys of its `TypedDict` and no others, and each of these is somewhere."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest

import symobs
from symobs import StateSpace
from symobs.tasks.result import Result, tasks
from tests.support.examples import NAMES, results_of
from tests.support.sampling import every

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

#: The results whose answers have no type yet: this list only gets shorter.
UNTYPED = {
    "AdvisedPoles",
    "CharacteristicPolynomial",
    "Decomposition",
    "DisturbanceObserver",
    "Dual",
    "Equilibria",
    "GainDesign",
    "IntegralAction",
    "ModeResult",
    "OfLoop",
    "OutputFeedback",
    "PutAgain",
    "ReducedOrderObserver",
    "RootLocus",
    "SampledController",
    "SampledPlant",
    "StabilityRegion",
    "TransferFunction",
}

PLANT = StateSpace("[0 1; -2 -3]", "[0; 1]", "[1 0]")
#: Its modes have no closed form, and sums over them no certain denominators.
OPEN = StateSpace("[0 1 0; 0 0 1; -a -b -c]", "[0; 0; 1]", "[1 0 0]")
SAMPLED = StateSpace("[1 1; 0 1]", "[0; 1]", "[1 0]", dt=1)
#: What no worked example has in its answer: open questions, refuted data, samples.
FURTHER: dict[str, Callable[[], Any]] = {
    "an open power": lambda: symobs.matrix_exponential(StateSpace("[0 1 0; 0 0 1; -a -b -c]", dt=1)),
    "an open Gramian": lambda: symobs.gramian(OPEN),
    "an open state": lambda: symobs.initial_state(OPEN, output="exp(-t)"),
    "a refuted output": lambda: symobs.initial_state(PLANT, output="exp(-5*t)"),
    "inconsistent outputs": lambda: symobs.initial_state(StateSpace("[-1]", C="[1; 1]"), output="[exp(-t); 2*exp(-t)]"),
    "samples": lambda: symobs.initial_state(SAMPLED, output="1, 2, 3"),
    "refuted samples": lambda: symobs.initial_state(SAMPLED, output="1, 2, 5"),
    "an open covariance": lambda: symobs.initial_state_covariance(OPEN, R="r"),
    "an open energy": lambda: symobs.minimum_energy_input(OPEN, final="1, 0, 0"),
    "an unreachable state": lambda: symobs.minimum_energy_input(StateSpace("[-1 0; 0 -2]", "[1; 0]"), final="1, 1"),
    "an open response": lambda: symobs.response(OPEN, input="1"),
    "an open hold": lambda: symobs.zero_order_hold(OPEN),
}


class Key(NamedTuple):
    """What a type says of a key."""

    is_required: bool
    may_be_none: bool


def keys_of(kind: type[Result]) -> dict[str, Key] | None:
    """Return what the type of the answers says of each key; None where they have none."""
    owner = next(base for base in kind.__mro__ if "answer" in vars(base).get("__annotations__", {}))
    if owner is Result:
        return None
    typed: Any = vars(sys.modules[owner.__module__])[owner.__annotations__["answer"]]
    found = {}
    for name, reference in typed.__annotations__.items():
        text = reference.__forward_arg__
        is_required = text.startswith("Required[") or (
            name in typed.__required_keys__ and not text.startswith("NotRequired[")
        )
        found[name] = Key(is_required, "None" in text)
    return found


def with_parts(result: Result) -> Iterator[Result]:
    """Yield a result and those it is made of."""
    yield result
    for name in result.__dataclass_fields__:
        part = getattr(result, name)
        if isinstance(part, Result):
            yield from with_parts(part)


def misfits(result: Result) -> Iterator[str]:
    """Yield what is wrong with the keys of an answer."""
    keys = keys_of(type(result))
    if keys is None:
        return
    for name, value in result.answer.items():
        if name not in keys:
            yield f"{name} is no key of the type"
        elif value is None and not keys[name].may_be_none:
            yield f"{name} is None, and its type does not say so"
    yield from (f"{name} is missing" for name, key in keys.items() if key.is_required and name not in result.answer)


@pytest.mark.parametrize("name", every(4, NAMES, 1))
def test_an_answer_has_the_keys_of_its_type(name: str) -> None:
    for result in results_of(name):
        for part in with_parts(result):
            assert not [*misfits(part)], type(part).__name__


@pytest.mark.parametrize("name", FURTHER)
def test_so_has_one_of_no_worked_example(name: str) -> None:
    assert not [*misfits(FURTHER[name]())]


def test_a_result_has_a_type_for_its_answer() -> None:
    tasks()
    kinds = [kind for kind in Result.__subclasses__() if kind.__module__.startswith("symobs.")]
    assert {kind.__name__ for kind in kinds if keys_of(kind) is None} == UNTYPED


@pytest.mark.slow
def test_every_key_of_a_type_is_in_an_answer() -> None:
    seen: dict[type[Result], set[str]] = {}
    for result in [*(found for name in NAMES for found in results_of(name)), *(solve() for solve in FURTHER.values())]:
        for part in with_parts(result):
            for kind in type(part).__mro__:
                if "answer" in vars(kind).get("__annotations__", {}):
                    seen.setdefault(kind, set()).update(part.answer)
    never = {kind.__name__: (keys_of(kind) or {}).keys() - names for kind, names in seen.items()}
    assert not {name: keys for name, keys in never.items() if keys}
