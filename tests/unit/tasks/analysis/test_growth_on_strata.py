"""Where a mode grows in general and some strata are left undecided: it grows there too, and the verdict says so."""

from __future__ import annotations

import pytest

import symobs
from symobs.pages.formats.json import result_object


@pytest.mark.slow
@pytest.mark.parametrize("meaning", ["asymptotic", "lyapunov"])
def test_an_undecided_stratum_does_not_make_a_growing_mode_conditional(meaning: str) -> None:
    A = "[0 0 -1 a^2-1; 0 1 0 0; 0 0 a*b a+b; 1 0 0 a*b]"  # x2 grows by itself and is not seen, whatever a and b are
    plant = symobs.StateSpace(A, "[-1; 0; 0; 2]", "[2 0 -1 1]", symbols={"a": "nonzero", "b": "negative"})
    answer = symobs.detectability(plant, meaning=meaning)
    assert {case["verdict"] for case in result_object(answer)["cases"]} == {"no", "undecided"}
    assert answer.verdict == "no"
