"""The documentation as a site: built with warnings as errors, asking nobody for anything, its examples right."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from dataclasses import replace
from importlib import import_module
from typing import TYPE_CHECKING, Any

import pytest

from symobs.cli.command_line import COMMANDS
from symobs.tasks.result import tasks
from tests.support.paths import ROOT
from tests.support.tools.browser import Watched
from tests.support.tools.command_line import SAFETY, environment

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.slow  # the extra `docs` is not among those of the quick tests
EXAMPLES = ("servo_observer", "bridge_circuit", "region_nonconvex")
LIVE = "https://example.org/live/"


@pytest.fixture(name="site", scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site with a gallery of a few examples, built in a copy so that the checkout stays as it is."""
    pytest.importorskip("sphinx", reason="needs Sphinx: pip install symobs[docs]")
    folder: Path = tmp_path_factory.mktemp("site")
    kept = shutil.ignore_patterns("_cache", "gallery", "reference", "__pycache__")
    shutil.copytree(ROOT / "docs", folder / "docs", ignore=kept)
    for name in (
        "symobs",
        "worked_examples",
        "latex_templates",
        "pyproject.toml",
        "CHANGELOG.md",
        "CONTRIBUTING.md",
        ".github",
    ):
        (folder / name).symlink_to(ROOT / name)
    options = ["-W", "-n", "-q", "-D", f"symobs_examples={','.join(EXAMPLES)}", "-D", f"symobs_live={LIVE}"]
    command = [sys.executable, "-m", "sphinx", *options, "docs", "out"]
    run = subprocess.run(
        command, cwd=folder, env=environment(folder), capture_output=True, text=True, timeout=SAFETY, check=False
    )
    assert run.returncode == 0, run.stdout + run.stderr
    return folder / "out"


def page(site: Path, name: str) -> str:
    return (site / f"{name}.html").read_text("utf-8")


def test_the_reference_has_everything_there_is(site: Path) -> None:
    assert [name for name in tasks() if f'id="symobs.{name}"' not in page(site, "reference/tasks")] == []
    assert [name for name in COMMANDS if f"Usage: symobs {name}" not in page(site, "reference/command_line")] == []
    python = page(site, "reference/python")
    for name in ("StateSpace.from_control", "Result.at", "Result.evaluate", "batch", "check", "live", "InputError"):
        assert f'id="symobs.{name}"' in python, name
    assert '"polynomial": "s**2 + 20*s + 100"' in re.sub("<[^>]*>", "", page(site, "reference/json")).replace(
        "&quot;", '"'
    )


def test_the_gallery_shows_solved_examples(site: Path) -> None:
    for name in EXAMPLES:
        text = page(site, f"gallery/examples/{name}")
        assert "<math" in text
        assert "symobs-" in text or name != "region_nonconvex"
        assert f'href="{LIVE}#v=1&amp;task=' in text
    shown = page(site, "gallery/stability_region")
    assert 'href="examples/region_nonconvex.html"' in shown
    assert "<svg" in shown.partition('class="gallery"')[2].partition("</a>")[0]
    found = (site / "searchindex.js").read_text("utf-8")
    assert '"gallery/examples/bridge_circuit"' in found


def test_links_within_the_site_lead_somewhere(site: Path) -> None:
    for path in site.rglob("*.html"):
        for link in re.findall(r'(?:href|src)="([^"#?]+)', path.read_text("utf-8")):
            if not re.match(r"https?:|data:|mailto:", link):
                assert (path.parent / link).exists(), f"{path.name}: {link}"


def test_no_page_asks_anybody_for_anything(site: Path, chromium: Any) -> None:
    pages = ["index", "guide", "reference/tasks", "reference/python", "gallery/stability_region"]
    pages += ["gallery/examples/servo_observer"]
    opened = Watched(chromium)
    opened.show(390)
    for name in pages:
        opened.page.goto((site / f"{name}.html").as_uri())
        assert opened.page.evaluate("document.documentElement.scrollWidth") <= 390, name
    opened.page.goto(f"{(site / 'search.html').as_uri()}?q=bridge")
    opened.page.wait_for_selector("#search-results li a", timeout=60_000)
    found = opened.page.eval_on_selector_all("#search-results a", "all => all.map(a => a.href)")
    assert "bridge_circuit" in str(found)
    assert [url for url in opened.requests if not url.startswith(("file:", "data:"))] == []


def test_an_example_that_is_not_what_it_expects_ends_the_build(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "docs" / "_site"))
    gallery: Any = import_module("gallery_pages")
    right = gallery.example("servo_observer")
    assert "<math" in gallery.solve("servo_observer")
    wrong = replace(right, text=right.text.replace('L = "[19; 81]"', 'L = "[19; 80]"'))
    monkeypatch.setattr(gallery, "example", lambda _: wrong)
    with pytest.raises(ValueError, match=r"servo_observer: .*L"):
        gallery.solve("servo_observer")
