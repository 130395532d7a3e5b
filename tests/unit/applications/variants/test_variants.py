"""Variants of files: the same for ever, distinct, alike, and each of them solved and checked."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft202012Validator  # type: ignore[import-untyped]

import symobs as so
from symobs.applications.variants import TooFew, Variants, variant_of
from symobs.applications.variants.acceptance import candidate, cheap, coordinate_key, data_key, run
from symobs.applications.variants.constraints import unlike
from symobs.applications.variants.search import schema
from symobs.applications.variants.table import read_table
from symobs.ground.errors import CertificateRejected, ProblemErrors, UsageError
from symobs.problem import read
from symobs.problem.expect import mismatches
from symobs.tasks.result import render
from tests.kit import tabled, tables
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

FOLDER = ROOT / "worked_examples" / "variants"
GOLDEN = json.loads((ROOT / "tests" / "unit" / "applications" / "variants" / "golden.json").read_text("utf-8"))
OBSERVER = (FOLDER / "observer.toml").read_text("utf-8")


def found(text: str, count: int, seed: int = 7, **more: Any) -> Variants:
    return Variants(text, count, seed, in_process=True, **more)


def golden(variants: Variants) -> list[list[Any]]:
    """What must never change: numbers of candidates, ids, and the hash of the file; what a page costs may."""
    listed = [(each.candidate, each.id, hashlib.sha256(each.text.encode()).hexdigest()[:12]) for each in variants]
    return [list(each) for each in listed]


def test_a_file_gives_the_variants_that_it_always_gave() -> None:
    three = found(OBSERVER, 3)
    assert golden(three) == GOLDEN["observer"][:3]
    Draft202012Validator(schema()).validate(three.manifest)
    assert three[0].text == found(OBSERVER, 1)[0].text
    assert sum(three.rejected.values()) == three[2].candidate - 2
    assert {each.id for each in three}.isdisjoint(each.id for each in found(OBSERVER, 1, 8))
    for each in three:
        problem = read(each.text)
        results = problem.solve()
        assert mismatches(problem.viewed(results), problem.expect) == []
        assert set(problem.expect) == {"L"}
        assert unlike(each.profile, three[0].profile, three.table.load, same_peak=False) is None


def numbers_of_page(text: str) -> Iterator[str]:
    page = render((problem := read(text)).document(problem.solve()), "fragment")
    page = re.sub(r"\\begin\{tikzpicture\}.*?\\end\{tikzpicture\}", "", str(page), flags=re.DOTALL)
    formulas = r"\$[^$]+\$|\\\[.*?\\\]|\\begin\{(align|equation|gather)\*?\}.*?\\end\{\1\*?\}"
    for formula in re.finditer(formulas, page, flags=re.DOTALL):
        yield from re.findall(r"\d+", re.sub(r"\\\\\[\d+pt\]|penalty=?\d+|arraystretch\}\{[0-9.]+", "", formula[0]))


@pytest.mark.slow
@tabled
def test_variants_of_the_examples(name: str) -> None:
    text = (FOLDER / f"{name}.toml").read_text("utf-8")
    variants = found(text, 4)
    assert golden(variants) == GOLDEN[name][:4]
    for each in variants:
        problem = read(each.text)
        assert mismatches(problem.viewed(problem.solve()), problem.expect) == []
    longest = max(map(len, numbers_of_page(variants[3].text)))
    assert longest <= variants.table.constraints.get("page", {}).get("digits", 99)
    assert longest <= variants[3].profile["peak"]


LETTERS = """
title = "A drive with time constant {c}"
task  = "state_feedback"
[plant]
A = "[0 1; 0 -1/c]"
B = "[0; 1/c]"
[specification]
poles = "-q, -q"
[expect]
K = "[c*q^2, 2*c*q - 1]"
[variants.parameters]
c = { set = ["1/2", "1", "2"] }
q = { integers = [2, 9] }
"""


def test_what_a_file_expects_in_letters_is_held_against_every_variant() -> None:
    """s^2 + (1 + k2)/c s + k1/c = (s + q)^2."""
    assert len(found(LETTERS, 3)) == 3
    with pytest.raises(ProblemErrors, match=r"expect\.K: expected .* for A = .*, poles = -") as refused:
        list(found(LETTERS.replace("2*c*q - 1", "2*c*q + 1"), 3))
    assert "variants.parameters" in str(refused.value)


def test_what_is_expected_of_a_files_own_plant_is_not_expected_of_its_variants() -> None:
    text = (
        'task = "state_feedback"\n[plant]\nA = "[0 1 0; 0 0 1; 1 2 3]"\nB = "[0; 0; 1]"\n'
        '[specification]\npoles = "-1, -2, -3"\n[expect]\nK = "[7 13 9]"\n'
        '[variants]\nconstruct = "state_feedback"\ndifficulty = { like = "base", load = "90%" }\n'
    )
    assert len(found(text, 2)) == 2
    with pytest.raises(ProblemErrors, match=r"expect\.K"):
        found(text.replace("[7 13 9]", "[7 13 8]"), 2)[0]


# -- what is distinct -------------------------------------------------------------------------------------------------


def drawn(plant: str) -> Any:
    specification = '[specification]\npoles = "p"\n[variants.parameters]\np = { poles = 2, from = [-2, -2] }\n'
    return candidate(read_table(f'task = "observer"\n[plant]\n{plant}\n{specification}'), 0, 0)


def test_the_same_plant_in_other_coordinates_is_known() -> None:
    one = drawn('A = "[1 2; 3 4]"\nB = "[1; 0]"\nC = "[1 5]"')
    exchanged = drawn('A = "[4 3; 2 1]"\nB = "[0; 1]"\nC = "[5 1]"')
    turned = drawn('A = "[1 -2; -3 4]"\nB = "[-1; 0]"\nC = "[1 -5]"')
    other = drawn('A = "[1 2; 3 4]"\nB = "[1; 0]"\nC = "[1 -5]"')
    assert coordinate_key(one) == coordinate_key(exchanged) == coordinate_key(turned)
    assert coordinate_key(one) != coordinate_key(other)
    assert len({data_key(each) for each in (one, exchanged, turned, other)}) == 4


def test_the_order_of_poles_makes_no_new_problem() -> None:
    text = 'task = "observer"\n[plant]\nA = "[0 1; 0 a]"\nC = "[1 0]"\n[specification]\npoles = "{}"\n'
    text += "[variants.parameters]\na = {{ set = [1] }}\n"
    first, second, third = (candidate(read_table(text.format(p)), 0, 0) for p in ("-1, -2", "-2, -1", "-1, -1"))
    assert data_key(first) == data_key(second) != data_key(third)


# -- the table --------------------------------------------------------------------------------------------------------


def test_parameters_stand_in_place_of_their_letters() -> None:
    text = """
title = "With {a} and {b}"
tasks = ["observability", "observer"]
[plant]
A = "[0 a; 2*a -b^2]"
C = [["a", "1 - b"]]
[specification]
observer_poles = "p"
[variants.parameters]
a = { set = [-3] }
b = { set = ["1/2"] }
p = { poles = 2, from = [-4, -4] }
when = ["a < b", "a b = -3/2"]
"""
    made = candidate(read_table(text), 0, 0)
    assert made.data["title"] == "With -3 and 1/2"
    assert made.data["plant"] == {"A": "[0 -3; -6 -1/4]", "C": "[-3 1/2]"}
    assert made.data["specification"] == {"observer_poles": "-4, -4"}
    assert cheap(read_table(text), made).reason is None
    other = text.replace("a < b", "a > b")
    assert cheap(read_table(other), candidate(read_table(other), 0, 0)).reason == "when: a > b"


@tabled
def test_an_observer_that_is_no_faster_than_the_control_is_left_out(
    control: str, observer: str, dt: str, reason: str
) -> None:
    text = f"""
task = "compensator"
[plant]
A = "[0 1; 0 a]"
B = "[0; 1]"
C = "[1 0]"
{dt}
[specification]
control_poles  = "{control}"
observer_poles = "{observer}"
[variants.parameters]
a = {{ set = ["-1"] }}
p = {{ poles = 2, from = [-3, -3] }}
"""
    text = text if "p" in f"{control}{observer}" else text.replace("p = {", "# ")
    assert (cheap(read_table(text), candidate(read_table(text), 0, 0)).reason or "") == reason


BAD = """
task = "observer"
[plant]
A = "[0 1; 0 0]"
[symbols]
a = "real"
[variants]
construct = { kind = "observer", ordre = 2, plant_poles = [0, 1] }
distinct = "all"
attempt = 3
difficulty = { like = "that", load = "much" }
[variants.parameters]
a = { integers = [3, 1] }
s = { poles = 3, from = [-1, 1], complex = true }
b = { range = "1:-1:4" }
c = { sets = [1] }
[variants.constraints]
observable = "yes"
integer = "L"
digits = { L = 0 }
page = { digit = 3 }
colour = "red"
plant_poles = "whole"
discriminant_square = ["K"]
"""


def test_all_errors_of_the_table_come_together_with_place_and_repair() -> None:
    with pytest.raises(ProblemErrors) as raised:
        Variants(BAD, 1)
    told = {error.where: error for error in raised.value.errors}
    assert set(told) == {
        "plant.A",
        "variants.attempt",
        "variants.construct.ordre",
        "variants.constraints.colour",
        "variants.constraints.digits.L",
        "variants.constraints.discriminant_square",
        "variants.constraints.integer",
        "variants.constraints.observable",
        "variants.constraints.page.digit",
        "variants.constraints.plant_poles",
        "variants.difficulty.like",
        "variants.difficulty.load",
        "variants.distinct",
        "variants.parameters.a",
        "variants.parameters.a.integers",
        "variants.parameters.b",
        "variants.parameters.b.range",
        "variants.parameters.c",
        "variants.parameters.s",
        "variants.parameters.s.poles",
    }
    assert all(error.repair for error in told.values())
    with pytest.raises(ProblemErrors, match=r"specification.colour: unknown key"):
        found(OBSERVER + '\n[specification]\ncolour = "red"\n', 1)[0]  # the first eleven are left out before
    with pytest.raises(ProblemErrors, match="this file stands for many problems"):
        read(OBSERVER)


@tabled
def test_only_whole_seeds_are_taken(seed: Any) -> None:
    with pytest.raises(UsageError, match="is no seed"):
        Variants(OBSERVER, 1, seed)


def test_what_nothing_meets_ends_after_the_attempts_with_the_reasons() -> None:
    text = OBSERVER.replace("observer_poles = [-9, -3]", "observer_poles = [-50, -50]").replace("L = 3", "L = 1")
    with pytest.raises(TooFew, match=r"0 of 3 variants .* 300 candidates.*most often .*: ") as raised:
        list(found(text, 3, attempts=300))
    counts: Any = raised.value.facts["rejected"]
    assert sum(counts.values()) == 300
    assert "L has too many digits" in counts


def test_what_is_no_problem_file_is_refused() -> None:
    for wrong in ({"task": "observer"}, None):
        with pytest.raises(UsageError, match="problem: a problem file is expected"):
            so.variants(wrong, 2)  # type: ignore[arg-type]


def test_the_number_of_a_variant_stands_in_the_language_of_its_file() -> None:
    data = variant_of(f'language = "de"\n{OBSERVER}', "problem", 1)
    assert data["title"] == "An observer of second order, Variante 1"
    assert data["text"] == "Variante 1 mit Startwert 0."
    assert variant_of(OBSERVER, "problem", 1)["text"] == "Variant 1 of seed 0."


# -- constraints ------------------------------------------------------------------------------------------------------


def outcome(
    constraints: dict[str, Any], plant: dict[str, str], task: str = "characteristic_polynomial", **asked: str
) -> Any:
    problem = {"task": task, "plant": plant, "specification": asked}
    return run({"problem": problem, "constraints": constraints, "gains": {}})["result"]["reason"]


PLANTS = tables(Path(__file__))["plants"]
TRUE = {
    "observable": {"oscillator", "stable", "golden", "double"},
    "controllable": set(PLANTS),
    "stable_plant": {"stable", "double"},
    "unstable_plant": {"unobservable", "oscillator", "golden"},
    "minimal_phase": set(PLANTS) - {"stable"},
    "distinct_poles": set(PLANTS) - {"double"},
    "repeated_poles": {"double"},
    "real_poles": set(PLANTS) - {"oscillator"},
    "complex_poles": {"oscillator"},
}


@pytest.mark.parametrize("flag", TRUE)
def test_flags_say_what_is_so_of_plants_known_by_hand(flag: str) -> None:
    for name, plant in PLANTS.items():
        held = flag in TRUE and name in TRUE[flag]
        assert outcome({flag: held}, plant) is None
        assert outcome({flag: not held}, plant) == f"{flag} is not {str(not held).lower()}"


def test_bounds_are_those_of_the_numbers_of_the_answers() -> None:
    golden_plant, stable, asked = PLANTS["golden"], PLANTS["stable"], {"poles": "-6, -3"}
    assert outcome({"discriminant_square": ["plant"]}, golden_plant) == "the discriminant of plant is no square"
    assert outcome({"discriminant_square": ["plant"], "plant_poles": "rational"}, stable) is None
    assert outcome({"plant_poles": "rational"}, golden_plant) == "the plant's poles are not rational"
    # by hand: (6 A + 16 I) [-1/6; -1/6], the last column of 𝒪⁻¹, is L = [-11/3; 7/3]
    assert outcome({"integer": ["L"]}, stable, "observer", **asked) == "L is not whole"
    assert outcome({"denominators": {"L": 6}}, stable, "observer", **asked) is None
    assert outcome({"denominators": {"L": 4}}, stable, "observer", **asked) == "a denominator in L does not divide 4"
    assert outcome({"digits": {"L": 1}}, stable, "observer", **asked) == "L has too many digits"
    assert outcome({"digits": {"L": 2}, "answers_nonzero": ["L"]}, stable, "observer", **asked) is None
    assert outcome({"page": {"lines": 1}}, stable, "observer", **asked) == "the page has too many lines"
    assert outcome({"page": {"fractions": 0}}, stable, "observer", **asked) == "the page has too many fractions"


def test_a_compensator_is_stable_where_that_is_asked_for() -> None:
    # 1/(s^2 - 1) with K = [3 3], L = [6; 10]: F has the denominator s^2 + 9 s + 30.  (s - 1)/(s (s - 2)) has one pole
    # between its zeros 1 and infinity: no stable compensator stabilises it (Youla, Bongiorno and Lu, 1974).
    servo = {"A": "[0 1; 1 0]", "B": "[0; 1]", "C": "[1 0]"}
    never = {"A": "[0 1; 0 2]", "B": "[0; 1]", "C": "[-1 1]"}
    both = {"control_poles": "-1, -2", "observer_poles": "-3, -3"}
    assert outcome({"stable_compensator": True}, servo, "compensator", **both) is None
    assert outcome({"stable_compensator": True}, never, "compensator", **both) == "stable_compensator is not true"


def test_cheap_gains_that_the_engine_does_not_find_are_a_bug() -> None:
    problem = {"task": "observer", "plant": {"A": "[0 1; 0 0]", "C": "[1 0]"}, "specification": {"poles": "-1, -1"}}
    assert run({"problem": problem, "constraints": {}, "gains": {"L": [[2], [1]]}})["result"]["reason"] is None
    with pytest.raises(CertificateRejected, match="in whole numbers"):
        run({"problem": problem, "constraints": {}, "gains": {"L": [[2], [2]]}})


def test_relations_among_parameters_are_read_with_the_table() -> None:
    text = 'task = "observer"\n[plant]\nA = "[0 1; a b]"\nC = "[1 0]"\n[specification]\npoles = "-1, -2"\n'
    text += (
        '[variants.parameters]\na = { integers = [5, -5] }\nb = { set = ["1"] }\nwhen = ["a < c", "a <", "a != b"]\n'
    )
    with pytest.raises(ProblemErrors) as raised:
        Variants(text, 1)
    assert [str(error) for error in raised.value.errors if "when" in error.where] == [
        "variants.parameters.when[0]: c is no parameter; use those of [variants.parameters]: a, b",
        'variants.parameters.when[1]: "a <" is no relation; write when = ["a < b"]',
    ]
    assert "variants.parameters.a.integers" in {error.where for error in raised.value.errors}


def test_few_data_are_drawn_out_soon() -> None:
    """Of det [B AB] = 3 − v seven values of v make one pair that is not controllable, which no other one is like."""
    plant = '[plant]\nA = "[1 2; 0 v]"\nB = "[1; 1]"\n'
    text = f'task = "controllability"\n{plant}[variants.parameters]\nv = {{ integers = [3, 9] }}\n'
    with pytest.raises(TooFew, match="1 of 2 variants") as raised:
        list(Variants(text, 2, in_process=True))
    counts: Any = raised.value.facts["rejected"]
    assert sum(counts.values()) < 1000
