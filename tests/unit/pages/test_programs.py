"""What a program says of itself, and when none is written; that it runs right is in tests/oracles/test_programs_run.py."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import symobs
from symobs.exact.floating import margin_search
from symobs.exact.floating.sampled import Sampled
from symobs.ground.errors import CertificateRejected, InexactInput, InputError, SymobsError, UsageError
from symobs.tasks.result import formats
from tests.kit import SERVO

LANGUAGES = ("c", "matlab", "modelica", "python")
DESIGN = symobs.compensator(SERVO, control_poles="-2, -2", observer_poles="-10, -10")


def test_the_languages_are_those_that_call_themselves_programs() -> None:
    assert {name for name, found in formats().items() if hasattr(found, "is_program")} == set(LANGUAGES)


@pytest.mark.parametrize("language", LANGUAGES)
def test_gains_rounding_and_margin_stand_in_the_program(language: str) -> None:
    plant = symobs.StateSpace("[0 1; 0 -1/3]", "[0; 1]", "[1 0]")
    design = symobs.compensator(plant, control_poles="-2, -2", observer_poles="-10, -10")
    text = str(design.to(language, period="1/100"))
    assert re.search(r"K = \[4\.0 3\.6666666666666665\], rounded by at most 1\.5e-16\.", text)
    assert Fraction("1.5e-16") >= Fraction(11, 3) - Fraction(3.6666666666666665) > Fraction("1.4e-16")
    assert "with the period 1/100, by zero-order hold." in text
    stated = re.search(r"every eigenvalue of the sampled plant with this program has \|z\| < (0\.\d+)\.", text)
    assert stated is not None
    poles = np.exp(np.array([-2, -2, -10, -10]) / 100)
    assert max(poles) - 0.01 < float(stated[1]) < 1


@pytest.mark.parametrize("asked", [("python", {"period": Fraction(1, 100)}), ("modelica", {})])
def test_a_margin_that_is_found_wrongly_is_not_said(
    asked: tuple[str, dict[str, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The search is not trusted: what it finds is proved again."""
    found = margin_search._largest
    monkeypatch.setattr(margin_search, "_largest", lambda *given: 5 * (found(*given) or 0))
    name, period = asked
    with pytest.raises(CertificateRejected, match=r"the margin .* is not proved"):
        DESIGN.to(name, **period)


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("hold", ["zoh", "tustin"])
def test_a_loop_that_is_not_stable_with_this_period_is_refused(language: str, hold: Any) -> None:
    unstable = symobs.StateSpace("[0 1; 4 0]", "[0; 1]", "[1 0]")
    design = symobs.compensator(unstable, control_poles="-3, -4", observer_poles="-9, -10")
    assert "Proved" in design.to(language, period="1/50", hold=hold)
    with pytest.raises(
        InputError, match="the sampled plant with this program is not proved stable; choose a shorter period"
    ):
        design.to(language, period=2, hold=hold)


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_bad_rounding_is_refused(language: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rounded to two digits the program does not hold an unstable plant any more; rounded to doubles it does."""
    plant = symobs.StateSpace("[0 1; 4 0]", "[0; 1]", "[1 0]")
    design = symobs.compensator(plant, control_poles="-1/10, -1/5", observer_poles="-2, -3")
    assert "Proved" in design.to(language, period="1/100")
    right = Sampled.rounded

    def to_two_digits(self: Any) -> Any:
        found = right(self)
        rounded = [[[Fraction(f"{float(e.fraction()):.1e}") for e in row] for row in m.rows] for m in found]
        return type(found)(*(type(found.A).of(rows) for rows in rounded))

    monkeypatch.setattr(Sampled, "rounded", to_two_digits)
    with pytest.raises(InputError, match="is not proved stable"):
        design.to(language, period="1/100")


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (lambda: DESIGN.to("c"), UsageError, r'--period: a program .*; .* --period 1/100, in Python period="1/100"'),
        (lambda: DESIGN.to("python", period=0.1), InexactInput, '--period: .* write an exact value such as "1/10"'),
        (lambda: DESIGN.to("python", period=0), UsageError, "0 is not a period; give a positive number"),
        (lambda: DESIGN.to("python", period="k"), SymobsError, "--period: .*k"),
        (
            lambda: DESIGN.to("latex", period="1/2"),
            UsageError,
            "a period belongs to a program; .* c, matlab, modelica, python",
        ),
        (
            lambda: DESIGN.to("c", period="1/2", hold="foh"),
            UsageError,
            "'foh' is no way to sample; use one of zoh, tustin",
        ),
        (
            lambda: symobs.observability(SERVO).to("c", period="1/2"),
            UsageError,
            "observability has no observer and no compensator; use observer",
        ),
        (
            lambda: symobs.observer(symobs.StateSpace("[0 1; -a 0]", None, "[1 0]"), poles="-1, -k").to(
                "c", period="1/9"
            ),
            InputError,
            r"code needs numbers, and a, k have no value; set them: --set a=1, or \.at\(a=1\) in Python",
        ),
        (
            lambda: symobs.observer(symobs.StateSpace("[1 0; 0 2]", None, "[1 0]"), poles="-1, -2").to(
                "c", period="1/9"
            ),
            InputError,
            "there is no observer to write: its verdict is no",
        ),
        (
            lambda: symobs.compensator(
                symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]", "[1]"),
                control_poles="-1, -2",
                observer_poles="-3, -4",
            ).to("c", period="1/9"),
            InputError,
            "the plant has feedthrough D",
        ),
        (
            lambda: symobs.observer(symobs.StateSpace([["1/2"]], None, [[1]], dt=True), poles="0").to("c", period=1),
            UsageError,
            "the plant is in discrete time already; leave the period out",
        ),
        (
            lambda: symobs.observer(symobs.StateSpace([["1/2"]], None, [[1]], dt=True), poles="0").to("modelica"),
            UsageError,
            "the period of the plant is not known; give dt the period",
        ),
    ],
)
def test_refusals(call: Any, kind: type[Exception], message: str) -> None:
    with pytest.raises(kind, match=message):
        call()
