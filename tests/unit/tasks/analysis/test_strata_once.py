"""What is found on a stratum is found once, for the whole problem, and ends as undecided where it would be too much."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import symobs
from symobs.exact import Scalar
from symobs.system import findings
from symobs.tasks.analysis.rank.rank_test import RankResult
from symobs.tasks.design.gain.gain_design import GainDesign

if TYPE_CHECKING:
    import pytest

    from symobs.tasks.result import Result

a, b = Scalar.symbol("a"), Scalar.symbol("b")


def asked() -> Result:
    plant = symobs.StateSpace("[0 1 0; a 0 1; 0 b 0]", "[0; b; 1]", "[1 a 0]")
    return symobs.feedforward(plant, control_poles=[-1, -2, -3], observer_poles=[-4, -5, -6])


def test_no_gain_and_no_test_of_a_stratum_is_found_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    met: Counter[object] = Counter()
    for kind in (GainDesign, RankResult):
        before = kind.claims

        def claims(self: Any, before: Any = before) -> Any:
            if getattr(self, "piece", None) is None:  # the cases of a test are its own
                met[type(self), self.plant, self.answer.get("polynomial")] += 1
            return before(self)

        monkeypatch.setattr(kind, "claims", claims)
    found = asked()
    assert any(case.result is not None and case.result.case_tree for case in found.case_tree)
    assert set(met.values()) == {1}


def test_where_nothing_more_may_be_found_strata_are_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = asked()
    monkeypatch.setattr(findings, "_BUDGET", 0)
    short = asked()
    assert short == whole
    assert short.holds_where == whole.holds_where
    assert {case.when for case in short.case_tree} == {case.when for case in whole.case_tree}
    assert [case.result for case in short.case_tree] == [None] * len(short.case_tree)
