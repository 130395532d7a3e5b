"""What a gain can be: each kind where it is reached, and no answer beside a kind that it does not fit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import symobs
from symobs.ground.errors import CertificateRejected
from symobs.tasks.design.gain.gain_design import GainDesign
from symobs.tasks.design.gain.gain_kind import (
    AssignedGain,
    DecoupledGain,
    GainWithZeros,
    NoGainWithZeros,
    UnassignableGain,
)
from tests.kit import tabled, tables

CHAIN = symobs.StateSpace("[0 1 0; 0 0 1; 0 0 0]", "[0 0; 1 0; 0 1]", "[1 0 0; 0 1 0]")
#: The mode at 1 is neither seen nor moved.
HIDDEN = symobs.StateSpace("[0 1 0; 0 0 0; 0 0 1]", "[0; 1; 0]", "[1 0 0]")
THREE = [-1, -1, -1]
ASKED = tables(Path(__file__))["asked"]


def asked(name: str) -> GainDesign:
    _, plant, specification, _ = ASKED[name]
    found = symobs.observer(HIDDEN if plant == "HIDDEN" else CHAIN, **specification)
    assert isinstance(found, GainDesign)
    return found


@pytest.mark.parametrize("name", ASKED)
def test_a_gain_is_of_the_kind_that_was_asked_for_and_found(name: str) -> None:
    kind, _, specification, verdict = ASKED[name]
    found = asked(name)
    assert type(found.kind).__name__ == kind
    assert found.verdict == verdict
    assert (found.answer["L"] is None) == (verdict == "no")
    assert ("zero" in found.fields) == ("zero" in specification)


@tabled
def test_a_gain_beside_a_kind_without_one_is_rejected(name: str) -> None:
    found, denied = asked(name), asked("unassignable").kind
    with pytest.raises(CertificateRejected, match="exactly where its kind says so"):
        replace(found, kind=denied)
    with pytest.raises(CertificateRejected, match="exactly where its kind says so"):
        found.with_answer("L", None)


def test_a_gain_that_exists_cannot_be_called_unassignable() -> None:
    found = asked("assigned")
    assert found.desired is not None
    for kind in (UnassignableGain(found.desired), NoGainWithZeros(found.desired, ())):
        with pytest.raises(
            CertificateRejected, match=r"a gain L with these zeros is found|the claim X has the order of the kernel"
        ):
            replace(found, answer={**found.answer, "L": None}, kind=kind)


def test_another_gain_cannot_be_called_decoupled_or_be_said_to_have_zeros() -> None:
    dense = symobs.observer(CHAIN, poles=THREE, zero="(3, 1)")
    assert dense.desired is not None
    with pytest.raises(CertificateRejected, match="zeros in L"):
        replace(dense, kind=GainWithZeros(dense.desired, ((0, 0), (1, 0), (2, 0))))
    plant = symobs.StateSpace("[0 1; 0 0]", None, "[1 0; 0 1]")
    given = symobs.observer(plant, L="[2 0; 1 0]")
    wanted = symobs.observer(plant, poles=[-1, -1])
    assert wanted.desired is not None
    coupled = replace(given, kind=AssignedGain(wanted.desired))
    with pytest.raises(CertificateRejected, match="orders of the output errors"):
        replace(coupled, kind=DecoupledGain(wanted.desired))
