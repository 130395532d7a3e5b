"""A language is a folder of data: complete, with the slots, formulas and forms of every phrase, chosen for each page."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tomllib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import symobs
from symobs.formula.phrases import CONTINUES, PHRASES
from symobs.formula.phrases import languages as module
from symobs.formula.phrases.catalogue import phrases_of_modules
from symobs.formula.phrases.languages import ENGLISH, Counted, StateChoice, faults, language_named, languages
from symobs.ground.errors import DerivationRejected, InputError, UsageError
from symobs.pages.page.blocks import CaseBlock, Heading, Paragraph, every
from symobs.pages.page.narrator import narrate
from symobs.problem import read
from symobs.problem.question import question_of
from symobs.proof.derivation import RegionSummary, Section
from symobs.tasks.result import Document, render
from tests.kit import SERVO
from tests.support.examples import document_of
from tests.support.paths import ROOT
from tests.support.problems.steps import HandWritten
from tests.support.tools.command_line import inside

FOLDERS = sorted(path.parent for path in (ROOT / "symobs" / "formula" / "phrases").glob("*/words.toml"))
GERMAN = ROOT / "symobs" / "formula" / "phrases" / "german"
EXAMPLES = ("servo_minimal_order", "region_two_intervals", "hidden_state_two_outputs", "routh_zero_row")


def document(name: str, language: str) -> Document:
    return replace(document_of(name), language=language)


# -- completeness -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_a_language_has_every_phrase_with_its_slots_formulas_and_forms(folder: Path) -> None:
    found = list(faults(folder))
    assert not found, "\n".join([f"{folder.name} is not complete:", *found])


@pytest.mark.parametrize("code", languages())
def test_everything_that_is_counted_is_put_into_words(code: str) -> None:
    language = language_named(code)
    for thing in language.counts:
        said = [language.put(Counted(thing, count, among=3)) for count in range(15)]
        assert not any("{" in text or not text.strip() for text in said), thing
    assert language.put(Counted("number", 4)) == language.numbers[4]
    assert len(language.numbers) == 13


def test_who_goes_on_with_a_sentence_is_declared() -> None:
    """In English it is seen from the first letter, in other languages not: so it is declared for all of them."""
    small = {key for key, phrase in PHRASES.items() if phrase[:1].islower()}
    missing = {
        key: name for name, phrases in phrases_of_modules().items() for key in phrases if key in small - CONTINUES
    }
    assert not missing, f"these begin in small letters: list them in CONTINUES of their module …_phrases.py: {missing}"
    assert not CONTINUES - small, f"these begin a sentence: take them out of CONTINUES: {sorted(CONTINUES - small)}"


@pytest.fixture(name="copy")
def copy_of_german(tmp_path: Path) -> Path:
    return Path(shutil.copytree(GERMAN, tmp_path / "german"))


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        (
            "rank.toml",
            re.compile(r"^case_zero = .*\n", re.MULTILINE),
            "",
            'write a translation of  "case_zero" = "In this',
        ),
        ("rank.toml", "Wegen {rank}", "Also", '"full_rank_observability" differs in its slots'),
        ("rank.toml", "das Paar ($C$, $A$) beobachtbar", "es beobachtbar", "differs in its formulas"),
        ("rank.toml", "ist§. Das Folgende", "ist. Das Folgende", "differs in its place of a citation"),
        (
            "modes.toml",
            "<Der einzige Eigenwert ist|Die Eigenwerte sind>",
            "Eigenwerte:",
            "differs in its forms for one",
        ),
        ("modes.toml", "pbh = ", 'nothing_such = "."\npbh = ', 'take out "nothing_such"'),
        ("words.toml", 'case = "Fall"\n', "", "'Case'"),
        ("words.toml", re.compile(r"^piece = .*\n", re.MULTILINE), "", 'write a translation of  "piece" in [COUNTS]'),
        ("words.toml", 'number = { other = "{word}" }', 'number = { 1 = "ein" }', "write the form other of number"),
    ],
)
def test_what_is_missing_or_wrong_is_named_with_its_file(
    copy: Path, file: str, old: str | re.Pattern[str], new: str, said: str
) -> None:
    path = copy / file
    text = path.read_text("utf-8")
    changed = text.replace(old, new) if isinstance(old, str) else old.sub(new, text)
    assert changed != text
    path.write_text(changed, "utf-8")
    found = list(faults(copy))
    assert any(said in fault for fault in found), found
    assert all(fault.startswith(str(path)) for fault in found)


def test_a_missing_file_is_named(copy: Path) -> None:
    (copy / "tracking.toml").unlink()
    found = list(faults(copy))
    assert len(found) == len(phrases_of_modules()["tracking"])
    assert all("tracking.toml: write a translation of" in fault for fault in found)


def test_a_third_language_is_one_folder(tmp_path: Path) -> None:
    """Every phrase in brackets, the numbers as digits: a copy of the package speaks it by this folder alone."""
    shutil.copytree(ROOT / "symobs", tmp_path / "symobs", ignore=shutil.ignore_patterns("__pycache__"))
    folder = tmp_path / "symobs" / "formula" / "phrases" / "bracketed"
    shutil.copytree(GERMAN, folder)
    for name in phrases_of_modules():
        path = folder / f"{name}.toml"
        path.write_text(re.sub(r'(?m)^(.*?) = "(.*)"$', r'\1 = "⟨\2⟩"', path.read_text("utf-8")), encoding="utf-8")
    words = (folder / "words.toml").read_text("utf-8").replace('code = "de"', 'code = "xx"')
    (folder / "words.toml").write_text(words, "utf-8")
    program = (
        "import symobs; from symobs.formula.phrases.languages import languages;"
        "print(languages(), symobs.__file__);"
        "print(symobs.observability(symobs.StateSpace('[0 1; 0 -1]', C='[1 0]')).to('text', language='xx'))"
    )
    run = [sys.executable, "-c", program]
    text = subprocess.run(
        run, cwd=tmp_path, env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True, check=True
    )
    assert text.stdout.startswith(f"('en', 'de', 'xx') {tmp_path}")
    assert "⟨Die Beobachtbarkeitsmatrix lautet⟩" in text.stdout


# -- pages --------------------------------------------------------------------------------------------------------------


#: Words that no German sentence contains.
_ENGLISH_WORDS = re.compile(r"\b(the|is|are|and|of|with|which|this|state|poles|case|root|roots|one)\b")


@pytest.mark.parametrize("name", EXAMPLES)
def test_a_german_page_has_no_english_word(name: str) -> None:
    told = replace(document(name, "de"), title="", source="", text="")
    for block in every(narrate(told)):
        if isinstance(block, Paragraph | Heading):
            inlines = block.inlines
        elif isinstance(block, CaseBlock):
            inlines = block.label
        else:
            continue
        for part in inlines:
            assert not isinstance(part, str) or not _ENGLISH_WORDS.search(part), part


def test_both_languages_are_told_side_by_side() -> None:
    result = symobs.observer(SERVO, poles=["-5/2", -3])
    alone = {code: result.to("text", language=code) for code in languages()}
    assert len(set(alone.values())) == len(alone)
    assert result.to("text") == alone["en"]
    with ThreadPoolExecutor(4) as pool:
        codes = [*languages()] * 3
        assert [alone[code] for code in codes] == list(pool.map(lambda code: result.to("text", language=code), codes))


def test_the_formats_are_told_their_language() -> None:
    result = symobs.observability(symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[0 1]"))
    latex, html = result.to_latex(language="de"), result.to_html(language="de")
    assert r"\usepackage[ngerman,provide=*]{babel}" in latex
    assert r"Hier gilt $\operatorname{rang}\mathcal O=1<2$" in latex
    assert '<html lang="de">' in html
    assert "[2, Kap. 2]" in latex.replace("; 2, Kap. 2]", "[2, Kap. 2]")
    assert "babel" not in result.to_latex()
    assert '<html lang="en">' in result.to_html()
    assert r"\usepackage[ngerman,provide=*]{babel}" in str(result.to("beamer", language="de"))


def test_decimals_have_a_comma() -> None:
    told = document("region_two_intervals", "de")
    latex, text = str(render(told, "latex")), str(render(told, "text"))
    assert re.search(r"\d\{,\}\d", latex) or re.search(r"\d,\d", text)
    assert not re.search(r"\d\.\d", text.partition("Literatur")[0].partition("Stabilitätsgebiet")[2])
    assert ENGLISH.decimal("-0.5") == "-0.5"
    assert language_named("de").decimal("-0.5") == "-0,5"


def test_choices_of_states() -> None:
    german = language_named("de")
    sets = {
        ((1,),): "state 1",
        ((1,), (3,)): "state 1 or state 3",
        ((1,), (2,), (4,)): "any one of the states 1, 2 and 4",
    }
    assert {each: ENGLISH.put(StateChoice(each)) for each in sets} == sets
    assert ENGLISH.put(StateChoice(((1, 3), (2, 3)))) == "states 1 and 3, or 2 and 3"
    assert german.put(StateChoice(((1,), (2,), (4,)))) == "einer der Zustände 1, 2 und 4"
    assert german.put(StateChoice(((1, 3), (2, 3)))) == "die Zustände 1 und 3 oder 2 und 3"


def test_a_false_number_in_a_sentence_is_rejected_in_every_language() -> None:
    """What is checked are numbers, not the words for them: a derivation has no language."""
    told = document_of("region_two_intervals")
    (derivation,) = told.derivations

    def lie(step: object) -> object:
        if isinstance(step, Section):
            return replace(step, steps=tuple(map(lie, step.steps)))  # type: ignore[arg-type]
        if not isinstance(step, RegionSummary):
            return step
        findings = [
            replace(said, slots=tuple((name, _one_more(slot)) for name, slot in said.slots)) for said in step.findings
        ]
        return replace(step, findings=tuple(findings))

    lying = replace(derivation, steps=tuple(map(lie, derivation.steps)))  # type: ignore[arg-type]
    assert lying != derivation
    for code in languages():
        with pytest.raises(DerivationRejected, match="the line that this is the region of chi_p"):
            render(HandWritten("", "", (), written=(lying,), language=code), "text")


def _one_more(slot: Any) -> Any:
    return replace(slot, count=slot.count + 1) if isinstance(slot, Counted) else slot


# -- how a language is asked for ----------------------------------------------------------------------------------------


PROBLEM = 'task = "observability"\n{extra}\n[plant]\nA = "[0 1; 0 -1]"\nC = "[1 0]"\n'


def test_a_problem_file_names_its_language() -> None:
    problem = read(PROBLEM.format(extra='language = "de"'), "p.toml")
    assert "Beobachtbarkeit" in str(render(problem.document(problem.solve()), "text"))
    assert "Ist das Paar (C, A) beobachtbar?" in str(render(question_of(problem), "text"))
    with pytest.raises(InputError, match="language: 'fr' is not a language of pages; use one of en, de"):
        read(PROBLEM.format(extra='language = "fr"'), "p.toml")
    with pytest.raises(InputError, match="language: a name is expected"):
        read(PROBLEM.format(extra="language = 5"), "p.toml")


def test_the_command_line_names_a_language(tmp_path: Path) -> None:
    path = tmp_path / "p.toml"
    path.write_text(PROBLEM.format(extra='language = "de"'), "utf-8")

    def told(*arguments: str) -> str:
        return inside(*arguments, "--format", "text").out

    assert "Beobachtbarkeit" in told("solve", str(path))
    assert "Observability" in told("solve", str(path), "--language", "en")
    task = ("observability", "--A", "[0 1; 0 -1]", "--C", "[1 0]", "--language")
    assert "Beobachtbarkeit" in told(*task, "de")
    refused = inside(*task, "fr")
    assert refused.code == UsageError.exit_code
    assert "'fr' is not a language of pages; use one of en, de" in refused.err
    sheet = told("sheet", str(path), str(path))
    assert "Aufgaben\n========" in sheet
    assert "Lösungen\n========" in sheet
    assert "Questions\n=========" in told("sheet", str(path), "--language", "en")


def test_a_phrase_without_a_translation_is_printed_in_english(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    words, german = copy / "words.toml", language_named("de")
    words.write_text(words.read_text("utf-8").replace('code = "de"', 'code = "yy"'), "utf-8")
    (copy / "gain.toml").unlink()
    monkeypatch.setattr(module, "_folders", lambda: {"yy": copy})
    found = language_named("yy")
    missing = phrases_of_modules()["gain"]
    assert {key: found.phrases[key] for key in missing} == missing
    assert all(found.phrases[key] == german.phrases[key] for key in found.phrases.keys() - missing)
    (copy / "words.toml").write_text('[WORDS]\ncode = "zz"\n', "utf-8")
    monkeypatch.setattr(module, "_folders", lambda: {"zz": copy})
    module._read.cache_clear()
    with pytest.raises(ValueError, match=r"words\.toml"):
        language_named("zz")


def test_every_file_of_a_language_is_read() -> None:
    for folder in FOLDERS:
        names = {path.stem for path in folder.iterdir()}
        assert names == {*phrases_of_modules(), "words"}
        for path in folder.iterdir():
            tomllib.loads(path.read_text("utf-8"))
