"""What is kept of a picture's parts is what the check itself finds: the same faults of the same pictures, in order."""

from __future__ import annotations

from dataclasses import replace

import pytest

from symobs.formula.figures import PoleMap, RegionPicture
from symobs.problem import read
from symobs.proof.derivation import Plot, plot_check
from tests.support.paths import ROOT
from tests.support.tampering.mutations import Line, changes, lines_of
from tests.support.tools.remembered import KEPT, remembered

EXAMPLES = ROOT / "worked_examples"


def faults(line: Line, step: Plot) -> list[str]:
    return list(plot_check.faults(step.picture, step.subject, line.start, discrete=line.derivation.discrete))


@pytest.mark.parametrize(
    ("stem", "kind"), [("region_third_order_loop", RegionPicture), ("region_discrete_one_gain", PoleMap)]
)
def test_what_is_kept_is_what_is_found(stem: str, kind: type) -> None:
    results = read((EXAMPLES / f"{stem}.toml").read_text("utf-8")).solve()
    lines = [line for result in results for line in lines_of(result.derivation)]
    plots = [(line, line.step) for line in lines if isinstance(line.step, Plot)]
    ((line, plot),) = ((line, step) for line, step in plots if isinstance(step.picture, kind))
    told = [replace(plot, picture=change.value) for change in changes(plot.picture)]
    told = told[:: len(told) // 40]
    anew = [faults(line, step) for step in told]
    with remembered():
        assert [faults(line, step) for step in told] == anew
        assert [faults(line, step) for step in reversed(told)] == anew[::-1]
    assert sum(map(bool, anew)) > 20


def test_nothing_is_kept_afterwards() -> None:
    own = [getattr(owner, name) for owner, name in KEPT]
    with remembered():
        assert all(getattr(owner, name) is not found for (owner, name), found in zip(KEPT, own, strict=True))
    assert [getattr(owner, name) for owner, name in KEPT] == own
