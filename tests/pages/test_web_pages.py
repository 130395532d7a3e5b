"""What a page of HTML offers besides its text: levels of detail without a script, buttons that copy LaTeX, a live link."""

from __future__ import annotations

import base64
import hashlib
import re
import subprocess
import tomllib
from html import unescape
from io import BytesIO
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import pytest
from matplotlib.image import imread

from symobs.pages.page.detail_level import DETAILS
from tests.support.tools.command_line import EXAMPLES, SERVO, inside

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

LIVE = "https://example.org/live/"


def html(*options: str) -> str:
    run = inside("solve", str(SERVO), "--format", "html", *options)
    assert (run.code, run.err) == (0, "")
    return run.out


def policy(page: str) -> str:
    (found,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', page)
    return str(found)


def body(page: str) -> str:
    """What stands below the title, without ids."""
    told = page.partition('<main class="symobs">')[2].partition("</main>")[0]
    return re.sub(r' id="[^"]*"', "", re.sub(r'<h1>.*?</h1>\n<p class="source">.*?</p>', "", told)).strip()


def test_a_page_offers_nothing_by_itself() -> None:
    page = html()
    assert policy(page) == "default-src 'none'; style-src 'unsafe-inline'"
    assert not re.search(r"<script|<input|<button|data-latex|data-detail", page)


def test_every_level_of_detail_is_the_page_of_that_level() -> None:
    page = html("--details", "--detail", "outline")
    parts = re.split(r'<div data-detail="(\w+)">\n', body(page))
    assert parts[1::2] == list(DETAILS)
    for detail, told in zip(parts[1::2], parts[2::2], strict=True):
        assert told.removesuffix("</div>").removesuffix("</div>\n").strip() == body(html("--detail", detail)), detail
    assert re.findall(r'value="(\w+)" checked', page) == ["outline"]
    assert "<script" not in page
    ids = re.findall(r' id="([^"]*)"', page)
    assert len(ids) == len(set(ids)) > 0


def test_the_only_script_is_the_one_the_policy_names() -> None:
    page = html("--copy")
    (script,) = re.findall(r"<script>(.*?)</script>", page, re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert policy(page) == f"default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{digest}'"
    assert re.sub(r"\n<script.*?</script>|<div hidden=.*?</div>", "", page, flags=re.DOTALL).count("<script") == 0
    assert page.count("data-latex=") == html().count('<div class="display">')
    assert "<button" not in page  # where scripts do not run there are no buttons that do nothing


def test_the_link_holds_the_problem() -> None:
    (link,) = re.findall(r'<p class="live"><a href="([^"]*)"', html("--live", f"{LIVE}#old"))
    address, _, state = unescape(link).partition("#")
    given = dict(part.split("=", 1) for part in state.split("&"))
    problem = tomllib.loads(SERVO.read_text("utf-8"))
    assert address == LIVE
    assert unquote(given["transfer_function"]) == problem["plant"]["transfer_function"]
    assert (given["task"], unquote(given["control"])) == ("compensator", "-2, -2")


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["--format", "text", "--details"], "--details: the format text is no web page; use --format html"),
        (["--format", "pdf", "--copy"], "--copy: the format pdf is no web page"),
        (["--format", "latex", "--live", LIVE], "--live: the format latex is no web page"),
        (["--format", "html", "--live", "javascript:alert(1)"], '--live: "javascript:alert(1)" is not the address'),
        (["--format", "html", "--live", 'https://a"onclick='], "is not the address of a page"),
        (["--format", "html", "--live", ""], '--live: "" is not the address of a page'),
    ],
)
def test_what_is_offered_is_for_web_pages(options: list[str], reason: str) -> None:
    for command in ("solve", "sheet"):
        run = inside(command, str(SERVO), *options)
        assert (run.code, run.out) == (2, "")
        assert reason in run.err


def test_a_sheet_folds_solutions_and_leaves_questions_alone() -> None:
    plain = inside("sheet", str(SERVO), "--format", "html").out
    page = inside("sheet", str(SERVO), "--format", "html", "--details", "--copy", "--live", LIVE).out
    questions, solutions = page.partition("<main")[2].split('id="solutions"')
    assert "data-detail=" not in questions
    assert questions.count('class="live"') == 0
    assert solutions.count('<details class="solution">') == solutions.count('class="live"') == 1
    assert [solutions.count(f'data-detail="{detail}"') for detail in DETAILS] == [1, 1, 1]
    assert questions.count("data-latex=") == plain.split('id="solutions"')[0].count('<div class="display">')
    assert (
        "details"
        not in inside("sheet", str(SERVO), "--format", "html", "--questions", "--copy").out.partition("<main")[2]
    )


# -- in a browser -----------------------------------------------------------------------------------------------------


@pytest.fixture(name="files", scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder: Path = tmp_path_factory.mktemp("web")
    (folder / "page.html").write_text(html("--details", "--copy", "--live", LIVE), "utf-8")
    sheet = inside("sheet", str(SERVO), str(SERVO), "--format", "html", "--details").out
    (folder / "sheet.html").write_text(sheet, "utf-8")
    return folder


def shown(page: Any) -> list[str]:
    """Levels of detail that are to be seen."""
    found: list[str] = page.eval_on_selector_all(
        "[data-detail]", "all => [...new Set(all.filter(e => e.checkVisibility()).map(e => e.dataset.detail))]"
    )
    return found


@pytest.mark.slow
def test_levels_are_switched_without_a_script(chromium: Any, files: Path) -> None:
    context = chromium.new_context(java_script_enabled=False, viewport={"width": 320, "height": 700})
    page = context.new_page()
    page.goto((files / "page.html").as_uri())
    for detail in ("full", "answer", "outline"):
        page.check(f"input[value={detail}]")
        assert shown(page) == [detail]
    assert page.locator("button").count() == 0
    page.emulate_media(media="print")
    assert shown(page) == ["outline"]
    assert not page.is_visible("fieldset")
    page.emulate_media(media="screen")
    assert page.evaluate("document.documentElement.scrollWidth") <= 320
    page.goto((files / "sheet.html").as_uri())
    assert shown(page) == []
    page.locator("summary").nth(1).click()
    assert shown(page) == ["full"]
    page.emulate_media(media="print")
    assert page.locator("details math >> visible=true").count() > 0
    assert (
        page.locator("details").nth(0).locator("[data-detail=full] math").first.is_visible()
    )  # printed, though folded
    context.close()


#: Signs beside mathematics that stand on another line than it.
_PARTED = """() => [...document.querySelectorAll('p math')].flatMap(math => [math.previousSibling, math.nextSibling]
.filter(text => {
  const at = text === math.previousSibling ? text?.length - 1 : 0;
  if (text?.nodeType !== 3 || !/[(\\[),.;:\\]]/.test(text.data[at])) return false;
  const sign = document.createRange();
  sign.setStart(text, at);
  sign.setEnd(text, at + 1);
  const [a, b] = [sign.getBoundingClientRect(), math.getBoundingClientRect()];
  return a.bottom < b.top || a.top > b.bottom;
}).map(() => math.parentNode.textContent))"""


@pytest.mark.slow
def test_a_display_that_goes_on_shows_it(chromium: Any, files: Path) -> None:
    context = chromium.new_context(viewport={"width": 360, "height": 700})
    page = context.new_page()
    (files / "plain.html").write_text(html(), "utf-8")
    page.goto((files / "plain.html").as_uri())
    seen = set()
    for display in page.locator(".display").all():
        excess = display.evaluate("e => e.scrollWidth - e.clientWidth")
        if 0 < excess < 30:  # the shadow fades in
            continue
        is_wide = excess > 0
        for left in (0, 10_000):
            display.evaluate("(e, left) => { e.scrollLeft = left; }", left)
            dark = imread(BytesIO(display.screenshot()))[2, :, :3].min(axis=1) < 0.9  # a line above the formula
            assert (dark[:4].any(), dark[-4:].any()) == (is_wide and left > 0, is_wide and not left)
        seen.add(is_wide)
    assert seen == {True, False}
    context.close()


def test_no_line_begins_or_ends_between_mathematics_and_a_sign(chromium: Any, files: Path) -> None:
    page = chromium.new_page()
    page.goto((files / "page.html").as_uri())
    for width in range(320, 900, 20):
        page.set_viewport_size({"width": width, "height": 800})
        assert page.evaluate(_PARTED) == [], width
    page.close()


@pytest.mark.slow
def test_every_button_copies_what_tex_typesets(
    chromium: Any, files: Path, require_tool: Callable[[str], str], tmp_path: Path
) -> None:
    require_tool("pdflatex")
    context = chromium.new_context()
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    page, complaints, asked = context.new_page(), [], []
    page.on("console", lambda said: complaints.append(said.text))
    page.on("request", lambda request: asked.append(request.url))
    page.goto((files / "page.html").as_uri())
    buttons = page.locator("[data-detail=full] [data-latex] > button")
    assert buttons.count() == page.locator("[data-detail=full] .display").count() > 10
    copied = []
    for number in range(buttons.count()):
        button = buttons.nth(number)
        button.focus()
        button.press("Enter")
        page.wait_for_timeout(20)
        assert button.inner_text() == "copied"
        copied.append(page.evaluate("navigator.clipboard.readText()"))
    assert copied == page.eval_on_selector_all(
        "[data-detail=full] [data-latex]", "all => all.map(e => e.dataset.latex)"
    )
    assert (complaints, asked) == ([], [(files / "page.html").as_uri()])
    context.close()
    lines = [r"\documentclass{article}\usepackage{amsmath,amssymb}\begin{document}", *copied, r"\end{document}"]
    (tmp_path / "copied.tex").write_text("\n".join(lines), "utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "copied.tex"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, errors="replace", check=False)
    assert run.returncode == 0, run.stdout[-2000:]


@pytest.mark.slow
def test_a_clipboard_that_is_refused_is_said(chromium: Any, files: Path) -> None:
    context = chromium.new_context()
    page = context.new_page()
    page.add_init_script("navigator.clipboard.writeText = () => Promise.reject(new Error('no'))")
    page.goto((files / "page.html").as_uri())
    button = page.locator("[data-latex] > button").first
    button.focus()
    button.press("Enter")
    page.wait_for_timeout(20)
    assert button.inner_text() == "refused"
    context.close()


@pytest.mark.slow
def test_every_example_offers_all_and_keeps_its_ids_apart() -> None:
    for path in EXAMPLES[::20]:
        run = inside("solve", str(path), "--format", "html", "--details", "--copy", "--live", LIVE)
        ids = re.findall(r' id="([^"]*)"', run.out)
        assert len(ids) == len(set(ids)), path.stem
        assert run.out.count('class="live"') == 1
