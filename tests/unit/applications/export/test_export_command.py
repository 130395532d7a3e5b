"""The command `export`: files and folders in, complete exports out, or a reason and nothing at all."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path  # noqa: TC003
from xml.etree.ElementTree import fromstring
from zipfile import ZipFile

import pytest

from symobs.applications.export import FOLDERS, PLATFORMS, exercises, export
from symobs.ground.errors import ProblemErrors
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.tools.command_line import Run, inside

EXAMPLES = ROOT / "worked_examples"
HOSTILE = (
    r"</script> ]]> {@sy_A@} {#n#} [[input:ans9]] {1:NUMERICAL:=1} \(x\) $(x)$ `r 1+1` exsolution: 3 <pl-code> {{x}} &"
    " END SOLUTION"
)


def run(*arguments: object) -> Run:
    """The command line with these arguments."""
    return inside(*map(str, arguments))


def written(folder: Path) -> dict[str, bytes]:
    """The files below a folder."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def variants(folder: Path, count: int) -> Path:
    """A folder of variants: a servo with other poles each, and a manifest."""
    below = folder / "variants"
    below.mkdir()
    (folder / "manifest.json").write_text('{"schema": "symobs-variants/1"}')
    (folder / "sheet.toml").write_text("")
    for number in range(1, count + 1):
        (below / f"v{number:03d}.toml").write_text(
            f'title = "Thirty"\ntask = "observer"\n[plant]\nA = "[0 1; 0 -{number}]"\nB = "[0; 1]"\nC = "[1 0]"\n'
            f'[specification]\npoles = "-{number + 9}, -10"\n'
        )
    return folder


@pytest.mark.parametrize("platform", PLATFORMS)
def test_each_variant_is_exported_and_the_same_again(platform: str, tmp_path: Path) -> None:
    (each,) = exercises([str(variants(tmp_path, 3))])
    first = export(platform, [each])
    assert first == export(platform, [each])
    (content, *_) = first.values()
    names = [name for name in first if "thirty_" in name]
    match platform:
        case "prairielearn":
            (listed,) = (str(text) for name, text in first.items() if name.endswith("variants.json"))
            assert len({json.dumps(variant["question"]) for variant in json.loads(listed)}) == 3
        case "stack":
            assert [seed.text for seed in fromstring(str(content)).iter("deployedseed")] == ["1", "2", "3"]  # noqa: S314
        case "moodle":
            questions = fromstring(str(content))[1:]  # noqa: S314
            assert len({question.findtext("questiontext/text") for question in questions}) == 3
        case "qti" | "qti21":
            assert isinstance(content, bytes)
            assert len(ZipFile(io.BytesIO(content)).namelist()) == 4
        case _:
            assert len(names) == 3


@pytest.mark.parametrize(
    "sources", [["."], ["variants"], ["manifest.json"], ["variants/v001.toml", "variants/v003.toml"]]
)
def test_variants_are_one_question_however_they_are_named(
    sources: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for place in (variants(tmp_path, 3) / "variants").iterdir():  # as `symobs variants` names them
        place.write_text(place.read_text().replace("Thirty", f"Thirty, variant {place.stem[-1]}"))
    monkeypatch.chdir(tmp_path)
    (each,) = exercises(sources)
    assert len(each.variants) == (2 if len(sources) == 2 else 3)
    assert each.name.startswith("thirty_")
    assert "variant" not in each.name
    assert "<text>$course$/symobs/Thirty</text>" in str(export("moodle", [each])[""])


def test_variants_of_two_problems_are_two_questions(tmp_path: Path) -> None:
    for name in ("one", "other"):
        (tmp_path / name).mkdir()
        variants(tmp_path / name, 2)
    found = exercises([str(tmp_path / "one"), str(tmp_path / "other")])
    assert [len(each.variants) for each in found] == [2, 2]


@pytest.mark.parametrize("platform", PLATFORMS)
def test_the_command_writes_complete_files(platform: str, tmp_path: Path) -> None:
    target = tmp_path / "out"
    done = run("export", EXAMPLES / "servo_observer.toml", "--to", platform, "-o", target)
    assert (done.code, done.err) == (0, "")
    (each,) = exercises([str(EXAMPLES / "servo_observer.toml")])
    expected = {
        name: text.encode() if isinstance(text, str) else text for name, text in export(platform, [each]).items()
    }
    assert (written(target) if platform in FOLDERS else {"": target.read_bytes()}) == expected


@tabled
def test_what_a_platform_cannot_hold_is_refused_and_nothing_is_written(
    name: str, platform: str, reason: str, tmp_path: Path
) -> None:
    done = run("export", EXAMPLES / f"{name}.toml", "--to", platform, "-o", tmp_path / "out")
    assert done.code == 3
    assert reason in done.err
    assert list(tmp_path.iterdir()) == []


def test_a_fraction_is_refused_where_numbers_are_compared(tmp_path: Path) -> None:
    problem = tmp_path / "p.toml"
    problem.write_text(
        'task = "observer"\n[plant]\nA = "[0 1; 0 -1]"\nC = "[3 0]"\n[specification]\npoles = "-1, -2"\n',
        encoding="utf-8",
    )
    for platform in ("moodle", "rexams", "qti"):
        with pytest.raises(
            ProblemErrors, match="a fraction is no number of this platform; take variants with integer answers"
        ):
            export(platform, exercises([str(problem)]))
    assert export("stack", exercises([str(problem)]))


def test_marks_that_no_grader_holds_are_refused_all_at_once(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text(
        'task = "observer"\n[plant]\nA = "[0 1; 0 -1]"\nC = "[1 0]"\n[specification]\npoles = "-1, -2"\n'
        '[marking.credit]\nmirrored = "1/2"\n[[marking.milestone]]\nrelation = "L = [2; 0]"\npoints = 1\n'
    )
    (tmp_path / "b.toml").write_text('task = "observer"\n')
    with pytest.raises(ProblemErrors) as caught:
        exercises([str(tmp_path)])
    told = str(caught.value)
    assert "a.toml, marking.milestone: lines of a derivation are marked" in told
    assert "a.toml, marking.credit.mirrored: an exported grader does not find the slip mirrored" in told
    assert "b.toml, " in told


def test_usage(tmp_path: Path) -> None:
    example = EXAMPLES / "servo_observer.toml"
    assert run("export", "--to", "stack", "-o", tmp_path / "x").code == 2
    assert "take prairielearn, stack" in run("export", example, "--to", "canvas", "-o", tmp_path / "x").err
    assert run("export", example, "--to", "stack", "-o", tmp_path / "x", "--points", "-1").code == 2
    assert run("export", tmp_path, "--to", "stack", "-o", tmp_path / "x").code == 3
    unknown = run("export", example, "--to", "stack", "-o", tmp_path / "x", "--asked", "observer.Q")
    assert unknown.code == 2
    assert unknown.err.startswith("--asked: there is no observer.Q; did you mean observer.L?")
    (tmp_path / "file").write_text("")
    assert "this is a file" in run("export", example, "--to", "ipynb", "-o", tmp_path / "file").err
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


# -- hostile text -----------------------------------------------------------------------------------------------------


@pytest.fixture(name="hostile")
def hostile_problem(tmp_path: Path) -> str:
    path = tmp_path / "hostile.toml"
    quoted = json.dumps(HOSTILE)
    path.write_text(
        f'title = {quoted}\ntext = {quoted}\ntask = "observer"\n[plant]\nA = "[0 1; 0 -1]"\nC = "[1 0]"\n'
        '[specification]\npoles = "-1, -2"\n'
    )
    return str(path)


def visible(html: str) -> str:
    """What a reader of a page sees of it."""
    return "".join(fromstring(f"<div>{html}</div>").itertext())  # noqa: S314


def test_hostile_text_stands_literally_in_moodle_and_stack(hostile: str) -> None:
    for platform in ("moodle", "stack"):
        question = fromstring(str(export(platform, exercises([hostile]))[""]))[1]  # noqa: S314
        assert question.findtext("name/text") == HOSTILE
        body = question.findtext("questiontext/text", "")
        assert HOSTILE in visible(re.sub(r"\\[\[(].*?\\[\])]", "", body))
        commands = re.findall(r"\[\[\w+:\w+\]\]|\{[@#].*?[@#]\}|\{\d*:[A-Z]+:", body)
        own = ["[[input:ans1]]", "[[validation:ans1]]"] if platform == "stack" else ["{1:NUMERICAL:"] * 2
        assert commands == own
        text = body.split("<h4>")[0].split("</p>", 1)[1]  # behind the line of notation
        assert not re.search(r"[\\$`{}\[\]]", text.replace("`r 1+1`", ""))


def test_hostile_text_stands_literally_in_the_other_exports(hostile: str) -> None:
    sets = exercises([hostile])
    files = {name.split("/")[-1]: str(text) for name, text in export("prairielearn", sets).items()}
    assert json.loads(files["info.json"])["title"] == HOSTILE
    page = json.loads(files["variants.json"])[0]["params"]["question"]
    assert "<pl-" not in page
    assert "</script>" not in page
    assert HOSTILE in visible(re.sub(r"\$\$.*?\$\$", "", page))
    assert "script" not in files["question.html"]
    content = export("qti", sets)[""]
    assert isinstance(content, bytes)
    with ZipFile(io.BytesIO(content)) as package:
        item = fromstring(package.read(next(n for n in package.namelist() if n.startswith("items"))))  # noqa: S314
    assert item.get("title") == HOSTILE
    assert HOSTILE in "".join(item.itertext())
    rmd = next(str(text) for name, text in export("rexams", sets).items() if name.endswith(".Rmd"))
    assert "`" not in rmd
    assert re.findall(r"(?m)\bexsolution:", rmd) == ["exsolution:", "exsolution:"]  # the title's, and the file's own
    (cell,) = [cell for text in export("ipynb", sets).values() for cell in json.loads(text)["cells"][2:]]
    assert re.findall(r"(?:BEGIN|END) (?:HIDDEN TESTS|SOLUTION)", cell["source"]) == [
        "BEGIN HIDDEN TESTS",
        "END HIDDEN TESTS",
    ]


def test_the_gains_of_integral_action_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "servo.toml"
    plant = '[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n'
    file.write_text(f'task = "integral_action"\n{plant}[specification]\npoles = "-1, -2, -3"\n', "utf-8")
    ended = run("export", file, "--to", "stack", "-o", tmp_path / "out")
    assert ended.code == 3
    assert "integral_action.k_I: an exported grader does not hold K and k_I" in ended.err
    assert not (tmp_path / "out").exists()


#: A gain with a third, which no platform of decimals holds, and one without.
THIRD = 'task = "observer"\n[plant]\nA = "[0 1; 0 0]"\nC = "[3 0]"\n[specification]\npoles = [-1, -1]\n'
WHOLE = THIRD.replace("3 0", "1 0")
RANK = 'task = "observability"\n[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"\n'


def test_a_refusal_of_several_files_names_the_file(tmp_path: Path) -> None:
    for name, text in (("first", WHOLE), ("second", THIRD), ("third", THIRD), ("rank", RANK)):
        (tmp_path / f"{name}.toml").write_text(f'title = "{name}"\n{text}')

    def refused(*arguments: str) -> list[str]:
        ran = inside("export", *arguments, "-o", "out", folder=tmp_path)
        assert ran.code
        return [line.partition(": ")[0] for line in ran.err.splitlines()]

    places = refused("first.toml", "second.toml", "third.toml", "--to", "moodle")
    assert places == ["second.toml, observer.L", "third.toml, observer.L"]
    assert refused("second.toml", "--to", "moodle") == ["observer.L"]
    assert refused("first.toml", "rank.toml", "--to", "stack", "--asked", "observer.L") == ["rank.toml, --asked"]
    assert refused("first.toml", "missing.toml", "--to", "stack") == ["missing.toml"]
