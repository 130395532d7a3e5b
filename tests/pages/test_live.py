"""The page of `symobs serve` in a real browser: dragged, typed into, tabbed through, and looked at."""

from __future__ import annotations

import json
import random
import re
import subprocess
import sys
import threading
from typing import TYPE_CHECKING, Any
from urllib.parse import quote, unquote

import pytest

from symobs.applications.live import answer
from symobs.applications.live.server import AnswerBudget, Children, Server
from tests.support.live_link import problem_of
from tests.support.tools.command_line import environment

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

pytestmark = pytest.mark.slow
SERVO = "v=1&task=compensator&A=[0 1; 0 -1]&B=[0; 1]&C=[1 0]&control=-2, -2&observer=-10, -10"
PAIR = SERVO.replace("observer=-10, -10", "observer=-5+5/2i, -5-5/2i")
CASES = "v=1&task=observability&A=[0 1; -2 -3]&C=[1 c]&symbols=c:real"
REGION = "v=1&task=stability_region&A=[0 1; 9 0]&C=[0 1]&L=[h1; h2]&parameters=h1, h2&symbols=h1:real,h2:real"
LOCUS = "v=1&task=stability_region&polynomial=s^3+2 s^2+3 s+k&parameters=k&symbols=k:real"
#: Words that no German sentence contains.
ENGLISH_WORDS = re.compile(
    r"\b(the|is|are|and|with|this|poles|answers?|derivation|observer|row|save|copy)\b", re.IGNORECASE
)
_FIELD = ':is([data-set="{0}"], [data-where="{0}"]):visible'
PATIENCE = 60_000  # milliseconds; ends a page that hangs, measures nothing


@pytest.fixture(name="server", scope="module")
def running_server() -> Iterator[Server]:
    server = Server(budget=AnswerBudget(60, 1000))
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
    thread.start()
    yield server
    server.shutdown()
    thread.join()
    server.server_close()


class Opened:
    """A page with what it asked, what it was told, and what it complained about."""

    def __init__(self, chromium: Any, server: Server, state: str, **context: Any) -> None:
        self.context = chromium.new_context(viewport={"width": 1180, "height": 900}, **context)
        self.context.grant_permissions(["clipboard-read", "clipboard-write"])
        self.page = self.context.new_page()
        self.page.set_default_timeout(PATIENCE)
        self.asked: list[dict[str, Any]] = []
        self.complaints: list[str] = []
        self.others: list[str] = []
        self.open, self.most = 0, 0
        base = server.url.partition("#")[0]
        self.page.on("request", lambda request: self._begin(request, base))
        self.page.on("requestfinished", self._end)
        self.page.on("requestfailed", self._end)
        self.page.on("console", lambda said: self.complaints.append(said.text) if said.type == "error" else None)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(f"{server.url}&{quote(state, safe='=&')}")

    def _begin(self, request: Any, base: str) -> None:
        if not request.url.startswith((base, "data:", "blob:")):
            self.others.append(request.url)
        if request.method == "POST":
            self.asked.append(json.loads(request.post_data))
            self.open += self._is_tier_one(request)
            self.most = max(self.most, self.open)

    def _end(self, request: Any) -> None:
        self.open -= self._is_tier_one(request)

    @staticmethod
    def _is_tier_one(request: Any) -> bool:
        return request.method == "POST" and json.loads(request.post_data)["want"] in {"answer", "point", "view"}

    def at_rest(self) -> None:
        """Wait until every question is answered and drawn."""
        self.page.wait_for_selector(".card math, .map svg")
        self.page.wait_for_timeout(400)
        self.wait_for("!document.querySelector('[aria-busy=true]')")

    def wait_for(self, condition: str) -> None:
        """Wait until a condition holds; the policy of the page lets nobody evaluate it there again and again."""
        for _ in range(PATIENCE // 50):
            if self.page.evaluate(condition):
                return
            self.page.wait_for_timeout(50)
        pytest.fail(f"not within {PATIENCE} ms: {condition}")

    def latex(self, name: str) -> str:
        found: str = self.page.get_attribute(f'.card[data-name="{name}"] .display', "data-latex")
        return found

    def middle(self, handle: str, index: int = 0) -> tuple[float, float]:
        box = None
        while box is None:  # a handle that is drawn again at this moment has none
            box = self.page.locator(f'[data-handle="{handle}"] .hit').nth(index).bounding_box()
        return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def drag(self, begin: tuple[float, float], end: tuple[float, float], steps: int = 12) -> None:
        self.page.mouse.move(*begin)
        self.page.mouse.down()
        for k in range(1, steps + 1):
            self.page.mouse.move(*(a + (b - a) * k / steps for a, b in zip(begin, end, strict=True)))
        self.page.mouse.up()

    def swipe(self, begin: tuple[float, float], by: tuple[float, float], steps: int = 8) -> None:
        """Move one finger over the screen, as the system of a telephone tells it to the browser."""
        finger = self.context.new_cdp_session(self.page)
        for k in range(steps + 1):
            x, y = (a + b * k / steps for a, b in zip(begin, by, strict=True))
            kind = "touchMove" if k else "touchStart"
            finger.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y}]})
        finger.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
        finger.detach()

    def poles(self, key: str) -> str:
        found: str = self.page.input_value(f'[data-set="{key}"]')
        return found

    def put(self, text: str, place: str, *, rest: bool = True) -> None:
        """Type into the field with a label or at a place of the problem, leave it, and wait for the answer."""
        found = self.page.get_by_label(place) if " " in place else self.page.locator(_FIELD.format(place))
        found.fill(text)
        found.press("Tab")
        if rest:
            self.at_rest()

    def close(self) -> None:
        """Close; whatever the page did, it complained of nothing and asked nobody else."""
        self.context.close()
        assert self.complaints == []
        assert self.others == []


@pytest.fixture(name="opened")
def open_pages(chromium: Any, server: Server) -> Iterator[Callable[..., Opened]]:
    pages: list[Opened] = []

    def opening(state: str, **context: Any) -> Opened:
        pages.append(Opened(chromium, server, state, **context))
        pages[-1].at_rest()
        return pages[-1]

    yield opening
    for page in pages:
        page.close()


def count(text: str) -> int:
    return len([pole for pole in text.split(",") if pole.strip()])


def test_the_servo_opens(opened: Callable[..., Opened]) -> None:
    live = opened(SERVO)
    assert live.latex("K") == r"K=\begin{bmatrix}4&3\end{bmatrix}"
    assert live.latex("L") == r"L=\begin{bmatrix}19\\81\end{bmatrix}"
    assert live.latex("F") == r"F(s)=\frac{319s+400}{s^2+23s+161}"
    assert live.page.inner_text(".cards .verdict") == "Closed loop stable · Checked · 3 claims"
    live.page.wait_for_selector(".html math")
    assert "Observer" in live.page.inner_text(".html")
    live.page.get_by_label("Language").select_option("de")
    live.wait_for(
        "document.querySelector('.html math') && document.querySelector('.html').innerText.includes('Regler')"
    )
    assert live.latex("K") == r"K=\begin{bmatrix}4&3\end{bmatrix}"
    assert live.page.inner_text(".cards .verdict") == "Geschlossener Kreis stabil · Geprüft · 3 Aussagen"
    assert ENGLISH_WORDS.findall(live.page.inner_text(".grid").partition("Literatur")[0]) == []
    assert live.page.evaluate("document.activeElement.getAttribute('aria-label')") == "Sprache"
    live.page.go_back()
    live.wait_for("document.querySelector('.cards .verdict').innerText.includes('Checked')")


def test_each_language_has_its_labels_its_decimals_and_the_last_answer(opened: Callable[..., Opened]) -> None:
    live = opened(f"{SERVO}&language=xx")
    assert "no language xx" in live.page.inner_text(".message")
    live.page.get_by_label("Language").select_option("de")
    live.wait_for("document.querySelector('.cards .verdict').innerText.includes('Geprüft')")
    assert not live.page.is_visible(".message")
    live.page.click(".astext summary")
    assert "Übertragungsfunktion" in live.page.inner_text(".plant")
    asked = len(live.asked)
    live.put("-1,5, -2", "control_poles", rest=False)
    live.page.wait_for_selector(".plane .wrong:has-text('Dezimalkomma')")
    assert {ask["want"] for ask in live.asked[asked:]} <= {"page", "start"}
    live.put("-1,5; -2", "control_poles", rest=False)
    live.wait_for("document.querySelector('.card[data-name=K] .display').dataset.latex.includes('3&')")
    assert live.poles("control_poles") == "-1.5, -2"
    live.put("-(", "A Zeile 2 Spalte 2", rest=False)
    live.page.wait_for_selector(".symobs-live.stale")
    live.page.get_by_label("Sprache").select_option("en")
    live.wait_for(
        "document.querySelector('.symobs-live').lang === 'en' && document.querySelector('.plant .wrong span')"
    )
    assert "Checked" in live.page.inner_text(".cards .verdict")
    assert live.page.locator(".card math").count() > 2
    assert live.page.locator(".curve").count() > 2
    assert "stale" in live.page.get_attribute(".symobs-live", "class")


def test_the_last_answer_of_a_drag_belongs_to_the_last_place(opened: Callable[..., Opened]) -> None:
    live = opened(PAIR)
    x, y = live.middle("observer_poles.0")
    before = len(live.asked)
    live.drag((x, y), (x - 90, y - 60), steps=150)
    live.at_rest()
    assert live.most == 1
    assert 0 < len(live.asked) - before <= 152
    told = answer(
        {
            "schema": "symobs-live/1",
            "problem": {
                "task": "compensator",
                "plant": {"A": "[0 1; 0 -1]", "B": "[0; 1]", "C": "[1 0]"},
                "specification": {"control_poles": "-2, -2", "observer_poles": live.poles("observer_poles")},
            },
        }
    )
    assert live.poles("observer_poles") != "-5+5/2i, -5-5/2i"
    for card in told["cards"]:
        assert live.latex(card["name"]) == card["latex"]
    path = live.page.get_attribute(".curve.c0", "d")
    assert path.startswith("M40.0")


def test_a_response_says_when_it_settles_and_a_pole_what_it_does_alone(opened: Callable[..., Opened]) -> None:
    live = opened("v=1&task=observer&A=[0 1; 0 -1]&C=[1 0]&poles=-4, -4")
    # From e(0) = (1, 1): e₁ = (1 − 2t) e⁻⁴ᵗ and e₂ = (1 − 6t) e⁻⁴ᵗ are 0.02 for the last time at 0.954 and 1.497.
    first, second = live.page.locator(".legend small").all_text_contents()
    assert 0.9537 < float(first.removeprefix("settles in ")) < 0.97
    assert second == "settles in 1.5"
    live.page.focus('[data-handle="poles.0"]')
    assert live.page.locator(".readout:visible").all_text_contents() == ["−4", "alone settles in 0.978"]
    live.page.keyboard.press("ArrowLeft")
    live.at_rest()
    assert live.page.locator(".readout:visible").all_text_contents() == ["−9/2", "alone settles in 0.869"]


def test_a_pole_is_read_off_when_it_is_pointed_at_and_put_back_by_escape(opened: Callable[..., Opened]) -> None:
    live = opened(PAIR.replace("5/2i", "5i"))
    live.page.mouse.move(*live.middle("observer_poles.0"))
    # ζ = 5/√50, overshoot e^(−π) and ln 50 / 5
    expected = ["−5 ± 5 i", "ζ = 0.707, ωₙ = √50", "alone overshoots by 4.32 %", "alone settles in 0.782"]
    assert live.page.locator(".readout:visible").all_text_contents() == expected
    signs = ["control pole", "observer pole", "pole of the plant", "pole of F"]
    assert live.page.locator(".marks span").all_text_contents() == signs
    x, y = live.middle("observer_poles.0")
    live.page.mouse.down()
    live.page.mouse.move(x - 80, y - 40)
    live.page.keyboard.press("Escape")
    live.page.mouse.up()
    live.at_rest()
    assert live.poles("observer_poles") == "-5+5i, -5-5i"


def test_a_link_sets_a_task_which_the_page_checks(opened: Callable[..., Opened]) -> None:
    live = opened(f"{SERVO}&goal=settling:1,gain:100")
    met = live.page.locator("b.met")
    assert met.evaluate_all("all => all.map(e => e.dataset.met)") == ["false", "true"]  # ln 50 / 2 = 1.956
    assert live.page.locator(".goal").count() == 1
    live.put("-4, -4", "control_poles")  # K = [16 7], ln 50 / 4 = 0.978
    assert met.all_inner_texts()[0].startswith("(0.978) ✓")
    assert met.evaluate_all("all => all.map(e => e.dataset.met)") == ["true", "true"]
    live.put("80", "goal.gain")
    assert met.evaluate_all("all => all.map(e => e.dataset.met)") == ["true", "false"]  # L = (19, 81)
    assert "goal=settling:1,gain:80" in unquote(live.page.url)


def test_designs_are_pinned_side_by_side(opened: Callable[..., Opened]) -> None:
    live = opened("v=1&task=state_feedback&A=[0 1; 0 -1]&B=[0; 1]&C=[1 0]&poles=-1, -1")
    for poles in ("-2, -2", "-3, -3", "-4, -4", "-5, -5"):
        live.put(poles, "poles")
        live.page.get_by_role("button", name="Pin").click()
    rows = live.page.locator(".pins tbody tr")
    assert rows.count() == 3
    # K = (p², 2 p − 1); from x(0) = (1, 1) the largest |u| is |−p² − 2 p + 1|, at first
    for row, p in enumerate((3, 4, 5)):
        cells = rows.nth(row).locator("td").all_inner_texts()
        assert re.findall(r"-?\d+", cells[1]) == [str(p * p), str(2 * p - 1)]
        assert float(cells[2].replace("−", "-")) == pytest.approx(-(p * p) - 2 * p + 1, rel=5e-3)
    rows.nth(0).get_by_role("button", name="−3, −3", exact=True).click()
    live.at_rest()
    assert live.poles("poles") == "-3, -3"
    rows.nth(1).get_by_role("button", name="Take away −4, −4").click()
    assert rows.count() == 2


def test_changes_are_undone_done_again_and_begun_anew(opened: Callable[..., Opened]) -> None:
    live = opened(SERVO)
    for poles in ("-3, -3", "-4, -4"):
        live.put(poles, "control_poles")
    seen = []
    for name in ("Undo", "Undo", "Redo", "Redo", "Undo", "Back to the beginning of this problem"):
        live.page.get_by_role("button", name=name).click()
        live.at_rest()
        seen.append(live.poles("control_poles"))
    assert seen == ["-3, -3", "-2, -2", "-3, -3", "-4, -4", "-3, -3", "-2, -2"]
    assert live.page.get_by_role("button", name="Back to the beginning of this problem").is_disabled()
    live.page.keyboard.press("Control+z")
    live.at_rest()
    assert live.poles("control_poles") == "-3, -3"
    assert live.latex("K") == r"K=\begin{bmatrix}9&5\end{bmatrix}"  # s² + (1 + k₂) s + k₁ = (s + 3)²


def test_what_is_held_is_dropped_when_another_problem_takes_its_place(opened: Callable[..., Opened]) -> None:
    live = opened("v=1&task=observer&A=[0 1; 0 -1]&B=[0; 1]&C=[1 0]&poles=-4, -5")
    live.page.wait_for_selector("datalist option", state="attached")
    live.page.get_by_label("Task").select_option("compensator")
    live.at_rest()
    live.page.focus('[aria-label="Task"]')
    x, y = live.middle("control_poles.0")
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    live.page.keyboard.press("Control+z")
    live.at_rest()
    live.page.mouse.move(x - 50, y - 20, steps=3)
    live.page.mouse.up()
    live.at_rest()
    assert live.poles("poles") == "-4, -5"
    live.page.wait_for_selector(".page:not(.old) .html math")  # a derivation is asked for as soon as nothing is held


def test_nothing_of_another_problem_can_be_moved(opened: Callable[..., Opened]) -> None:
    live = opened(REGION)
    live.page.wait_for_selector("datalist option", state="attached")
    live.page.get_by_label("Task").select_option("compensator")
    live.page.wait_for_selector('[data-handle="control_poles.0"]')
    live.at_rest()
    for step in ("Undo", "Redo"):
        live.context.set_offline(offline=True)
        live.page.get_by_role("button", name=step).click()
        live.page.wait_for_selector(".message:not([hidden])")
        assert live.page.locator(":is(.plane, .region):not([inert]) input:visible").count() == 0
        live.context.set_offline(offline=False)
        live.page.get_by_role("button", name="Try again").first.click()
        live.wait_for("!document.querySelector('.symobs-live.busy, [inert]')")
    live.at_rest()
    live.complaints.clear()


def test_a_derivation_that_does_not_come_is_said(opened: Callable[..., Opened]) -> None:
    live = opened(PAIR)
    live.page.route(
        "**/api",
        lambda route: route.abort() if json.loads(route.request.post_data)["want"] == "page" else route.continue_(),
    )
    live.page.get_by_label("Detail").select_option("answer")
    live.page.get_by_role("button", name="Try again").wait_for()
    live.at_rest()
    live.page.unroute("**/api")
    live.page.click("text=Try again")
    live.page.wait_for_selector(".page:not(.old) .html math")
    live.complaints.clear()


@pytest.mark.parametrize(
    ("state", "hit", "fields"),
    [(PAIR, '[data-handle="observer_poles.0"] .hit', ["observer_poles"]), (REGION, ".pick .hit", ["at.h1", "at.h2"])],
    ids=["pole", "point"],
)
def test_a_finger_moves_what_it_touches_and_scrolls_beside_it(
    opened: Callable[..., Opened], state: str, hit: str, fields: list[str]
) -> None:
    live = opened(state, has_touch=True, is_mobile=True)
    live.page.set_viewport_size({"width": 360, "height": 700})

    def place() -> tuple[float, float]:
        live.page.evaluate("document.activeElement?.blur()")
        box = live.page.locator(hit).first.bounding_box()
        return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def told() -> list[str]:
        return [live.page.locator(_FIELD.format(field)).input_value() for field in fields]

    live.page.locator(hit).first.scroll_into_view_if_needed()
    live.at_rest()
    scrolled = live.page.evaluate("scrollY")
    for by in ((0, -30), (0, 25), (-30, 0), (25, 0)):
        (x, y), before = place(), told()
        live.swipe((x, y), by)
        live.at_rest()
        assert told() != before, by
        assert live.page.evaluate("scrollY") == scrolled, by
    (x, y), before = place(), told()
    live.swipe((x - 90 if x > 180 else x + 90, y), (0, -80))
    live.wait_for(f"scrollY > {scrolled}")
    live.at_rest()
    assert told() == before


def test_what_is_typed_and_not_entered_pales_the_answer_until_escape(opened: Callable[..., Opened]) -> None:
    live = opened(SERVO)
    live.page.wait_for_selector(".page:not(.old) .html math")
    stale = ".symobs-live.stale:has(.page.old)"
    for place, text in (
        ("control_poles", "-3, -4"),
        ("plant.A[2,2]", "-5"),
        ("goal.gain", "7"),
        ("courses.start", "2, 2"),
    ):
        if place == "goal.gain":
            live.page.click(".goals summary")
        field = live.page.locator(_FIELD.format(place))
        before, asked = field.input_value(), len(live.asked)
        field.focus()
        live.page.keyboard.press("Control+a")
        live.page.keyboard.type(text)
        live.page.wait_for_selector(stale)
        live.page.keyboard.press("Escape")
        live.page.wait_for_selector(".symobs-live:not(.stale):has(.page:not(.old))")
        assert field.input_value() == before
        assert len(live.asked) == asked
        live.page.keyboard.press("Control+a")
        live.page.keyboard.type(text)
        live.page.wait_for_selector(stale)
        live.page.keyboard.press("Enter")
        live.page.wait_for_selector(".symobs-live:not(.stale)")
        assert len(live.asked) > asked
        live.at_rest()
    assert problem_of(live.page.url)[0]["plant"]["A"] == "[0 1; 0 -5]"


def test_an_empty_field_says_nothing(opened: Callable[..., Opened]) -> None:
    live = opened("v=1&task=feedforward&A=[0 1; 0 -1]&B=[0; 1]&C=[1 0]&control=-2, -2&observer=-3, -4")
    live.put("", "observer_poles")
    assert live.latex("F") == "F=4"  # of u = −K x + F v, without an observer
    assert live.page.locator(".wrong:not(:empty)").count() == 0
    assert "observer" not in unquote(live.page.url)


def test_where_y_ends_stands_beside_the_reference_and_a_button_brings_it_there(opened: Callable[..., Opened]) -> None:
    state = "v=1&task=compensator&A=[0 1; -2 -1]&B=[0; 1]&C=[1 0]&control=-2, -2&observer=-10, -10&step=1"
    for task in ("feedforward", "integral action"):
        live = opened(state)
        # K = (2, 3), L = (19, 79), K (BK + LC − A)⁻¹ L = 82/159, and y ends at 41/159 / (1 + 41/159)
        assert "y ends at r = 1: (0.205) ✗" in live.page.inner_text("p.met")
        assert live.page.text_content(".responses .legend small").startswith("ends at 0.205")
        assert live.page.locator(".responses line.goal").count() == 1
        live.page.get_by_role("button", name=f"by {task}").click()
        live.page.wait_for_url(f"**task={task.replace(' ', '_')}**")
        live.page.wait_for_selector('b.met[data-met="true"]')
        live.at_rest()
        assert "y ends at r = 1: (1) ✓" in live.page.inner_text("p.met")
        assert live.page.get_by_role("button", name="by ").count() == 0


def test_the_convention_of_an_example_is_said_at_the_cards_and_leaves_by_a_button(
    opened: Callable[..., Opened],
) -> None:
    live = opened(f"{SERVO}&convention=plusK-plusMC")
    assert live.latex("K") == r"K=\begin{bmatrix}-4&-3\end{bmatrix}"
    live.page.get_by_role("button", name="convention plusK-plusMC").click()
    live.wait_for("document.querySelector('.card[data-name=K] .display').dataset.latex.includes('}4&3')")
    live.at_rest()
    assert "convention" not in live.page.url
    assert live.page.get_by_role("button", name="convention").count() == 0


def test_pairs_form_and_part(opened: Callable[..., Opened]) -> None:
    live = opened(PAIR)
    x, y = live.middle("observer_poles.0")
    axis = (y + live.middle("observer_poles.0", 1)[1]) / 2
    live.drag((x, y), (x, axis))
    live.at_rest()
    assert live.poles("observer_poles") == "-5, -5"
    assert live.page.locator(".handle.ring").count() == 2
    x, axis = live.middle("observer_poles.0")
    live.drag((x, axis), (x, axis - 70))
    live.at_rest()
    assert re.fullmatch(r"-5\+([\d/]+)i, -5-\1i", live.poles("observer_poles"))
    x, y = live.middle("observer_poles.0")
    live.drag((x, y), (x, (y + live.middle("observer_poles.0", 1)[1]) / 2))
    live.at_rest()
    x, axis = live.middle("observer_poles.1")
    live.drag((x, axis), (x - 80, axis))
    live.at_rest()
    moved = live.poles("observer_poles")
    assert moved.startswith("-5, -")
    assert moved != "-5, -5"


def test_tab_goes_through_the_entries_and_a_matrix_grows(opened: Callable[..., Opened]) -> None:
    live = opened(SERVO)
    focused = "document.activeElement.getAttribute('aria-label')"
    live.page.get_by_label("A row 1 column 1").focus()
    for typed, after in (("0", "A row 1 column 2"), ("1", "A row 2 column 1"), ("-2", "A row 2 column 2")):
        live.page.keyboard.press("Control+a")
        live.page.keyboard.type(typed)
        live.page.keyboard.press("Tab")
        live.page.keyboard.type("1")  # on top of what is chosen there, while the answer comes
        live.at_rest()
        assert live.page.evaluate(focused) == after
    assert live.page.input_value('[aria-label="A row 2 column 2"]') == "1"
    live.page.keyboard.press("Enter")
    live.at_rest()
    assert live.latex("K") == r"K=\begin{bmatrix}2&5\end{bmatrix}"  # s² − s + 2 + k₂ s + k₁ = (s + 2)²
    for kind in ("states", "outputs", "inputs"):
        live.page.get_by_role("button", name=f"more {kind}").click()
        live.at_rest()
        assert live.page.evaluate(focused) == f"more {kind}"
    problem, _ = problem_of(live.page.url)
    grown = {"A": "[0 1 0; -2 1 1; 0 0 0]", "B": "[0 0; 1 1; 1 0]", "C": "[1 0 0; 0 1 0]"}
    assert problem["plant"] == grown
    assert [count(poles) for poles in problem["specification"].values()] == [3, 3]
    for kind in ("states", "outputs", "inputs"):
        live.page.get_by_role("button", name=f"fewer {kind}").click()
        live.at_rest()
    assert problem_of(live.page.url)[0]["plant"] == {"A": "[0 1; -2 1]", "B": "[0; 1]", "C": "[1 0]"}


def test_matrices_that_do_not_fit_grow_without_harm(opened: Callable[..., Opened]) -> None:
    live = opened(SERVO)
    live.page.click(".astext summary")
    live.put("-2", "text.A", rest=False)
    live.page.wait_for_selector(".symobs-live.stale :is(.wrong, .message span):not(:empty)")
    for kind in ("inputs", "states"):
        live.page.get_by_role("button", name=f"more {kind}").click()
        live.wait_for("!document.querySelector('.symobs-live.busy')")
    assert problem_of(live.page.url)[0]["plant"]["A"] == "-2"  # there is no such problem, and the one shown stays


#: Grabs a handle and lets it go elsewhere, again and again; the poles that stand in their field after each.
MOVES = """(moves) => {
  const svg = document.querySelector('.plane svg');
  svg.setPointerCapture = () => {};
  const event = (kind, clientX, clientY) => new PointerEvent(kind, { bubbles: true, pointerId: 1, clientX, clientY });
  return moves.map(([pick, x, y]) => {
    const handles = svg.querySelectorAll('.handle'), handle = handles[Math.floor(pick * handles.length)];
    const box = svg.getBoundingClientRect(), hit = handle.querySelector('.hit').getBoundingClientRect();
    const places = [[hit.x + hit.width / 2, hit.y + hit.height / 2], [box.x + x * box.width, box.y + y * box.height]];
    handle.querySelector('.hit').dispatchEvent(event('pointerdown', ...places[0]));
    svg.dispatchEvent(event('pointermove', ...places[1]));
    svg.dispatchEvent(event('pointerup', ...places[1]));
    return document.querySelector('[data-set="poles"]').value;
  });
}"""


def test_no_move_changes_the_number_of_poles(opened: Callable[..., Opened]) -> None:
    live = opened("v=1&task=observer&A=[0 1 0; 0 0 1; -1 -2 -3]&C=[1 0 0]&poles=-2+i, -2-i, -4&closed=page,responses")
    generator = random.Random(5)  # noqa: S311 - repeatable by design
    uniform = generator.uniform
    moves = [[uniform(0, 1), uniform(0, 1), generator.choice([0.5, uniform(0, 1)])] for _ in range(300)]
    found = live.page.evaluate(MOVES, moves)
    assert len(set(found)) > 200
    for poles in found:
        assert count(poles) == 3, poles
        assert poles.count("i") in {0, 2}, poles
    assert {poles.count("i") for poles in found} == {0, 2}
    live.at_rest()
    assert live.most == 1
    assert "Checked" in live.page.inner_text(".cards .verdict")


def test_the_keyboard_alone_moves_poles(opened: Callable[..., Opened]) -> None:
    live = opened(PAIR)
    keyboard = live.page.keyboard
    for _ in range(40):
        keyboard.press("Tab")
        if live.page.evaluate("document.activeElement.dataset?.handle") == "observer_poles.0":
            break
    handle = '[data-handle="observer_poles.0"]'
    assert live.page.get_attribute(handle, "role") == "slider"
    assert live.page.get_attribute(handle, "aria-label") == "observer pole 1 of 1"
    assert live.page.get_attribute(handle, "aria-valuetext") == "−5 plus or minus 5/2 i"
    keyboard.press("ArrowLeft")
    keyboard.press("Shift+ArrowUp")
    assert live.poles("observer_poles") == "-11/2+15/2i, -11/2-15/2i"
    keyboard.press("Escape")
    assert live.poles("observer_poles") == "-5+5/2i, -5-5/2i"
    keyboard.press("Enter")
    keyboard.press("Control+a")
    keyboard.type("-7/3, -8")
    keyboard.press("Tab")
    live.at_rest()
    assert live.latex("L") == r"L=\frac{1}{3}\begin{bmatrix}28\\28\end{bmatrix}"  # 31/3 − 1, 56/3 − 28/3


def test_poles_are_moved_as_engineers_write_them_and_written_without_a_factor_of_one(
    opened: Callable[..., Opened],
) -> None:
    live = opened(SERVO.replace("observer=-10, -10", "observer=-5+j1/2, -5-j1/2"))
    live.page.locator('[data-handle="observer_poles.0"]').focus()
    live.page.keyboard.press("ArrowUp")
    assert live.poles("observer_poles") == "-5+i, -5-i"
    live.put("-1+2j3, -1-2j3", "control_poles", rest=False)  # which has no plain meaning
    live.wait_for("!document.querySelector('[data-handle^=control_poles]')")


_UNNAMED = """[...document.querySelectorAll('button, input, select, summary, [tabindex]')].filter(e => e.offsetParent
  !== null || e.ownerSVGElement).filter(e => !(e.getAttribute('aria-label') || e.textContent.trim() ||
  e.closest('label')?.textContent.trim())).map(e => e.outerHTML)"""
_WITHOUT_A_NAME = """[...document.querySelectorAll('svg[role], [role=slider], [role=group]')].filter(e => !e.closest('[hidden]')
  && !(e.getAttribute('aria-label') || e.querySelector(':scope > title'))).map(e => e.outerHTML.slice(0, 200))"""
_NESTED = "[...document.querySelectorAll(':is([role=img], button, a, label) :is([tabindex], button, a)')].map(e => e.outerHTML)"


@pytest.mark.parametrize("state", [PAIR, REGION, LOCUS, CASES], ids=["poles", "region", "locus", "cases"])
def test_a_reader_of_the_screen_finds_its_way(opened: Callable[..., Opened], state: str) -> None:
    live = opened(state)
    assert [live.page.evaluate(fault) for fault in (_UNNAMED, _WITHOUT_A_NAME, _NESTED)] == [[]] * 3
    assert live.page.locator("[tabindex]:not([tabindex='0'])").count() == 0
    assert live.page.locator("h1").count() == 1
    labels = live.page.eval_on_selector_all(
        "section:not([hidden])", "all => all.map(e => e.getAttribute('aria-label'))"
    )
    assert len(set(labels)) == len(labels)


def test_the_gains_stand_beside_what_is_moved(opened: Callable[..., Opened]) -> None:
    live = opened(SERVO)
    for width, height in ((320, 640), (1180, 720)):
        live.page.set_viewport_size({"width": width, "height": height})
        live.page.locator('[data-handle="control_poles.0"] .hit').scroll_into_view_if_needed()
        for place in ('[data-handle="control_poles.0"]', '.card[data-name="K"]', '.card[data-name="L"]'):
            box = live.page.locator(place).first.bounding_box()
            assert box["y"] >= 0, place
            assert box["y"] + box["height"] <= height, place


def test_a_bad_entry_is_said_at_its_field(opened: Callable[..., Opened]) -> None:
    live = opened(SERVO)
    live.put("q", "A row 2 column 2", rest=False)
    live.page.wait_for_selector(".symobs-live.stale .plant .wrong:has-text('q is not declared')")
    assert live.latex("K") == r"K=\begin{bmatrix}4&3\end{bmatrix}"
    assert live.page.eval_on_selector(".cards .list", "e => getComputedStyle(e).opacity") == "0.38"
    assert "--symbol" not in live.page.inner_text(".plant")
    live.page.get_by_role("button", name="a slider").click()  # A = [0 1; 0 q] at q = 1: s² + (k₂ − 1) s + k₁
    live.page.wait_for_selector(".symobs-live:not(.stale)")
    assert live.page.input_value('[data-where="at.q"]') == "1"
    assert live.latex("K") == r"K=\begin{bmatrix}4&5\end{bmatrix}"
    live.put("-2", "A row 2 column 2", rest=False)
    live.page.wait_for_selector(".symobs-live:not(.stale)")
    live.at_rest()
    assert live.latex("K") == r"K=\begin{bmatrix}4&2\end{bmatrix}"


def test_another_task_takes_over_what_it_is_asked(opened: Callable[..., Opened]) -> None:
    live = opened("v=1&task=observer&A=[0 1; 0 -1]&B=[0; 1]&C=[1 0]&poles=-4, -5")
    live.page.wait_for_selector("select option[value=compensator]", state="attached")
    live.page.get_by_label("task").select_option("compensator")
    live.page.wait_for_url("**task=compensator**")
    assert "observer=-4,%20-5" in live.page.url
    assert "poles=" not in live.page.url
    assert problem_of(live.page.url)[0]["specification"]["control_poles"] == "-2, -3"  # what is missing has a default
    live.put("-1, -2", "control_poles", rest=False)
    live.page.wait_for_selector(".symobs-live:not(.stale)")
    live.at_rest()
    # s² + (1 + k₂) s + k₁ = s² + 3 s + 2
    assert live.latex("K") == r"K=\begin{bmatrix}2&2\end{bmatrix}"


def test_every_task_of_the_menu_begins_with_an_answer(opened: Callable[..., Opened]) -> None:
    live = opened("language=de")
    live.page.wait_for_selector("datalist option", state="attached")
    menu = live.page.locator(".bar select").first
    for task in menu.locator("option").evaluate_all("all => all.map(e => e.value)"):
        menu.select_option(task)
        live.wait_for(f"document.querySelector('.symobs-live:not(.stale):not(.busy)')?.dataset.task === '{task}'")
        said = live.page.inner_text(".cards .verdict")
        assert said, task
        assert not ENGLISH_WORDS.search(said), task
        assert not live.page.is_visible(".message"), task
        assert live.page.locator(".wrong:not(:empty)").count() == 0, task


def act(live: Opened, draw: random.Random, examples: list[str]) -> None:
    """Do one thing that a user might do."""
    page = live.page

    def type_into(place: str, texts: list[str]) -> None:
        if (found := page.locator(f":is({place}):not([inert] *):visible")).count():
            field = found.nth(draw.randrange(found.count()))
            field.fill(draw.choice(texts))
            field.press("Tab")

    match draw.randrange(15):
        case 0:
            name = draw.choice(examples)
            for _ in range(draw.randint(1, 2)):  # chosen a second time, it begins anew
                page.locator(".bar input").fill(name)
        case 1:
            tasks = page.locator(".bar select").nth(0)
            tasks.select_option(draw.choice(tasks.locator("option").evaluate_all("all => all.map(e => e.value)")))
        case 10:
            page.locator(".bar select").nth(1).select_option(draw.choice(["en", "de"]))
        case 11 if (
            movable := page.locator(":is([data-where^='give.'], [data-where^='move.']):not([inert] *):visible")
        ).count():
            one = movable.nth(draw.randrange(movable.count()))
            if one.get_attribute("type") != "range":
                one.click()
            else:
                one.press(draw.choice(["ArrowLeft", "End", "PageUp"]))
        case 2 | 3:
            type_into("[data-set]", ["-3, -4", "-1/2, -7", "-2+j2, -2-j2", "1, 1", "nonsense", "-1", "-sqrt(2), -3"])
        case 4:
            type_into(
                "[data-where^='plant.'], [data-where^='specification.K'], [data-where^='specification.L']",
                ["0", "1", "-2", "1/2", "-1", "3", "(", "sqrt(3)"],
            )
        case 5:
            type_into(
                "[data-where^='at.'], [data-where^='goal.'], [data-where^='courses.']", ["2", "1/2", "1, 1", "", "x"]
            )
        case 6 if (sizes := page.locator(".size button:not([aria-disabled=true])")).count():
            sizes.nth(draw.randrange(sizes.count())).click()
        case 7 if (handles := page.locator(".handle .glyph")).count():
            box = handles.nth(draw.randrange(handles.count())).bounding_box()
            if box is not None:
                page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
                page.mouse.down()
                page.mouse.move(box["x"] + draw.randint(-90, 90), box["y"] + draw.randint(-60, 60), steps=4)
                if draw.random() < 0.3:
                    page.keyboard.press("Escape")
                page.mouse.up()
        case 12 | 13 | 14:
            act_in_one_place(live, draw)
        case _:
            page.locator(".bar > button.quiet").nth(draw.randrange(3)).click(force=True)


def act_in_one_place(live: Opened, draw: random.Random) -> None:
    """Type into a field and do not enter it, press a key on a handle, or move it by a finger."""
    page = live.page

    def any_of(place: str) -> Any:
        found = page.locator(f":is({place}):not([inert] *):visible")
        return found.nth(draw.randrange(found.count())) if found.count() else None

    if (field := any_of("input:is([data-where], [data-set]):not([type])")) is not None and draw.random() < 0.5:
        field.focus()
        page.keyboard.press("Control+a")
        page.keyboard.type(draw.choice(["-3, -4", "2", "-1/2", "", "(", "sqrt(2)"]))
        if draw.random() < 0.4:
            page.keyboard.press("Escape")
    elif (handle := any_of(".handle")) is not None and draw.random() < 0.5:
        handle.focus()
        page.keyboard.press(draw.choice(["ArrowLeft", "ArrowRight", "Shift+ArrowUp", "ArrowDown", "Escape"]))
    elif (glyph := any_of(".handle .glyph")) is not None and (box := glyph.bounding_box()) is not None:
        middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        live.swipe(middle, (draw.randint(-60, 60), draw.randint(-60, 60)), steps=4)


#: No question is under way, and what is pale says why; on a busy machine a question is asked before it is seen to be.
SETTLED = """!document.querySelector('.symobs-live[aria-busy=true]') && (
    !document.querySelector('.symobs-live.stale')
    || document.querySelector('.wrong:not(:empty)')
    || document.querySelector('input.typed')
    || [...document.querySelectorAll('.message')].some(message => message.checkVisibility()))"""


def walked(live: Opened, seed: int, steps: int, switch: Callable[[bool], None]) -> tuple[int, int]:
    """Walk at random, and return how often an answer stood in full ink, and how often it was pale.

    `switch` takes the server away, or gives it back.
    """
    page, draw, dead = live.page, random.Random(seed), False  # noqa: S311 - repeatable by design
    page.wait_for_selector("datalist option", state="attached")
    examples = page.locator("datalist option").evaluate_all("all => all.map(e => [e.value, e.textContent])")
    assert len({title for title, _ in examples}) == len(examples)
    picked = [title for title, _ in examples if "three gains" not in title]
    full = pale = 0
    for step in range(steps):
        if draw.random() < (0.5 if dead else 0.06):
            dead = not dead
            switch(dead)
        act(live, draw, picked)
        page.wait_for_timeout(200)  # longer than the page waits before it says that it is busy
        live.wait_for(SETTLED)
        where = f"step {step} of {seed}: {page.url}"
        assert [said for said in live.complaints if "net::ERR_" not in said] == [], where
        if page.locator(".symobs-live.stale").count():
            pale += 1
            continue
        assert page.locator("input.typed").count() == 0, where
        problem, at = problem_of(page.url)
        if (dt := problem["plant"].get("dt")) is not None:
            problem["plant"]["dt"] = {"true": True}.get(dt, int(dt) if dt.isdigit() else dt)
        seen = answer({"schema": "symobs-live/1", "want": "view", "problem": problem}).get("view", {})
        at = {name: value for name, value in at.items() if name not in seen.get("region", {}).get("parameters", [])}
        told = answer({"schema": "symobs-live/1", "problem": problem, "at": at, "cards_at": bool(at)})
        assert told["status"] in {"done", "no", "undecided"}, where
        assert [live.latex(card["name"]) for card in told["cards"]] == [card["latex"] for card in told["cards"]], where
        assert page.locator(".card:not(.conditions)").count() == len(told["cards"]), where
        said = page.text_content(".cards .verdict").replace("−", "-")
        assert said.startswith(told["says"]), where
        if page.locator(".point:not(.old):visible > .verdict").count():
            there = {
                field: page.input_value(f'.point [data-where="at.{field}"]') for field in seen["region"]["parameters"]
            }
            there = seen["region"].get("drawn_for", {}) | at | there
            point = answer({"schema": "symobs-live/1", "want": "point", "problem": problem, "at": there})
            assert page.get_attribute(".point .verdict", "data-verdict") == point["verdict"], where
        shown = page.locator(".page:not(.old):not([aria-busy=true]):visible .html math").count()
        if step % 5 == 0 and shown:
            derived = answer(
                {"schema": "symobs-live/1", "want": "page", "problem": problem, "at": at, "cards_at": bool(at)}
            )
            assert shown == derived["html"].count("<math"), where
        full += 1
    dead = False
    switch(dead)
    live.complaints.clear()  # of the network that was away
    return full, pale


def test_what_is_in_full_ink_answers_what_is_on_the_screen(opened: Callable[..., Opened]) -> None:
    live = opened(SERVO, has_touch=True)
    full, pale = walked(live, 20, 40, live.context.set_offline)
    assert full > 10
    assert pale > 3


def test_a_loop_that_is_not_stable_has_no_tick(opened: Callable[..., Opened]) -> None:
    live = opened(SERVO.replace("-2, -2", "5, -2"))
    verdict = live.page.locator(".cards .verdict")
    assert verdict.inner_text() == "Closed loop unstable: pole at 5 · Checked · 3 claims"
    assert verdict.evaluate("e => getComputedStyle(e, '::before').content") == '"✗ "'


def test_the_region_is_drawn_for_the_value_of_another_letter(opened: Callable[..., Opened]) -> None:
    live = opened(
        "v=1&task=stability_region&polynomial=s^3+2 s^2+h1 s+b h2&parameters=h1, h2&symbols=h1:real,h2:real,b:positive"
    )
    first = live.page.inner_html(".map")
    assert live.page.get_by_label("value of b").input_value() == ""  # a letter, drawn for the number beneath it
    live.put("3", "value of b", rest=False)
    live.wait_for(f"document.querySelector('.map').innerHTML !== {json.dumps(first)}")
    live.at_rest()
    for name, value in (("h1", "1"), ("h2", "1")):  # stable exactly for 2 h₁ > b h₂ > 0
        live.put(value, f"at.{name}", rest=False)
    live.at_rest()
    assert live.page.get_attribute(".point .verdict", "data-verdict") == "unstable"
    live.put("", "value of b")
    assert not live.page.is_visible(".message")
    assert live.page.get_attribute(".point:not(.old) .verdict", "data-verdict") == "stable"


def test_the_gain_moves_the_roots_along_their_locus(opened: Callable[..., Opened]) -> None:
    live = opened("v=1&task=root_locus&transfer_function=1/(s*(s+1)*(s+2))&symbols=k:positive")
    dots = "[...document.querySelectorAll('.map .root')].map((e) => e.getAttribute('cx'))"
    verdict = "() => document.querySelector('.point:not(.old) .verdict')?.dataset.verdict"
    live.put("1", "at.k", rest=False)
    live.at_rest()
    first = live.page.evaluate(dots)
    assert len(first) == 3
    assert live.page.evaluate(verdict) == "stable"
    live.put("7", "at.k", rest=False)  # above the crossing at k = 6
    live.at_rest()
    assert live.page.evaluate(verdict) == "unstable"
    assert live.page.evaluate(dots) != first
    live.put("6", "at.k", rest=False)
    live.at_rest()
    assert live.page.evaluate(verdict) == "boundary"


def test_a_case_is_set_exactly(opened: Callable[..., Opened]) -> None:
    live = opened(CASES)
    live.page.get_by_role("button", name="c = 1", exact=True).click()
    live.at_rest()
    assert live.page.get_attribute(".cards .verdict", "data-verdict") == "no"
    assert live.latex("kernel") == r"N=\begin{bmatrix}-1\\1\end{bmatrix}"
    assert live.page.input_value('[data-where="at.c"]') == "1"
    assert live.page.get_attribute(""".chosen[data-case]""", "data-case") == '{"c":"1"}'
    live.page.click("text=in general")
    live.at_rest()
    assert live.page.get_attribute(".cards .verdict", "data-verdict") == "conditional"


def test_a_gain_is_moved_and_its_poles_follow(opened: Callable[..., Opened]) -> None:
    live = opened("v=1&task=state_feedback&A=[0 1; 0 -1]&B=[0; 1]&C=[1 0]&poles=-2, -3")
    live.page.get_by_role("button", name="move K").click()
    live.page.wait_for_url("**&K=*")
    live.at_rest()
    assert "poles" not in problem_of(live.page.url)[0]["specification"]
    assert live.page.locator(".plane .handle").count() == 0
    entry = live.page.locator('[data-where="move.specification.K[1,1]"]')
    for _ in range(20):
        entry.press("ArrowLeft")  # a twentieth each
    live.at_rest()
    # s² + (1 + k₂) s + k₁ for K = (5, 4): −5/2 ± i √5/2
    assert problem_of(live.page.url)[0]["specification"] == {"K": "[5 4]"}
    assert live.latex("polynomial") == r"\chi_{A-BK}(s)=s^2+5s+5"
    assert live.page.locator(".plane .picture .mark.control_pole").count() == 2
    live.put("-60", "specification.K[1,1]", rest=False)  # farther than the slider went
    live.page.wait_for_selector('[data-verdict="unstable"]')
    assert live.page.get_attribute('[data-where="move.specification.K[1,1]"]', "min") == "-200"
    live.page.get_by_label("undo").click()
    live.at_rest()
    assert live.page.input_value('[data-where="move.specification.K[1,1]"]') == "100"  # twentieths
    live.page.get_by_role("button", name="poles for K").click()
    live.page.wait_for_url("**&poles=*")
    live.at_rest()
    assert live.page.locator(".plane .handle").count() == 2


def test_a_derivation_begins_as_an_outline_whose_parts_open(opened: Callable[..., Opened]) -> None:
    live = opened(SERVO)
    parts = live.page.locator(".html details")
    assert parts.locator("summary").all_inner_texts() == [
        "Given", "1. State feedback", "2. Observer", "3. Compensator", "4. Closed loop",
    ]  # fmt: skip
    assert live.page.locator(".html .display:visible").count() == 0
    parts.nth(1).locator("summary").click()
    shown = live.page.locator(".html .display:visible").count()
    assert shown == parts.nth(1).locator(".display").count() > 0
    live.put("-2, -5", "control_poles")
    live.page.wait_for_selector(".page:not(.old)")
    assert parts.evaluate_all("all => all.map(e => e.open)") == [False, True, False, False, False]
    live.page.emulate_media(media="print")
    assert live.page.locator(".html .display:visible").count() == live.page.locator(".html .display").count() > shown


def test_a_letter_has_a_slider(opened: Callable[..., Opened]) -> None:
    live = opened("v=1&task=observer&A=[0 1; -omega^2 0]&C=[1 0]&poles=-2, -2&symbols=omega:positive")
    assert r"\omega" in live.latex("L")
    live.put("3/2", "value of omega")
    assert live.latex("L") == r"L=\begin{bmatrix}4\\[4pt]\frac{7}{4}\end{bmatrix}"  # 4 − 9/4
    assert live.page.locator(".curve.c0").first.get_attribute("d")
    slider = live.page.get_by_label("omega, positive")
    assert slider.get_attribute("min") == "0"


def test_the_verdict_of_a_point_changes_on_the_boundary(opened: Callable[..., Opened]) -> None:
    live = opened(REGION)  # s² + h₂ s + 9 h₁ − 9: stable exactly for h₁ > 1 and h₂ > 0
    verdict = ".point .verdict"
    assert live.page.get_attribute(verdict, "data-verdict") == "stable"
    for point, expected in (
        (("1", "1"), "boundary"), (("1001/1000", "1"), "stable"), (("999/1000", "1"), "unstable"),
        (("2", "0"), "boundary"), (("2", "1/20"), "stable"), (("2", "-1/20"), "unstable"),
    ):  # fmt: skip
        for name, value in zip(("h1", "h2"), point, strict=True):
            live.put(value, f"at.{name}", rest=False)
        live.at_rest()
        assert live.page.get_attribute(verdict, "data-verdict") == expected, point
    box = live.page.locator(".pick .hit").bounding_box()
    begin = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    live.drag(begin, (begin[0], begin[1] - 60))
    live.at_rest()
    assert live.page.get_attribute(verdict, "data-verdict") == "stable"


def test_the_point_stands_where_its_fields_say_after_undo(opened: Callable[..., Opened]) -> None:
    live = opened(REGION)
    field, dot = live.page.locator('.point [data-where="at.h2"]'), live.page.locator(".pick")
    for value in ("2", ""):
        before = field.input_value(), dot.get_attribute("transform")
        live.put(value, "at.h2")
        live.page.get_by_role("button", name="Undo").click()
        live.at_rest()
        assert (field.input_value(), dot.get_attribute("transform")) == before
    live.context.set_offline(offline=True)
    live.put("3", "at.h2", rest=False)
    live.page.wait_for_selector(".message:not([hidden])")
    live.page.get_by_role("button", name="Undo").click()
    live.wait_for("document.querySelector('.point:not(.old) > .verdict')?.textContent.includes('h2 = 1')")
    live.context.set_offline(offline=False)
    live.at_rest()  # what is still on its way complains of the network before it is looked at
    live.complaints.clear()


def test_a_point_that_cannot_be_read_is_said_at_its_field(opened: Callable[..., Opened]) -> None:
    live = opened(f"{REGION}&language=de")
    field = live.page.locator('.point [data-where="at.h1"]')
    for given, said in (("sqrt(2)", ""), ("x", "x")):
        live.put(given, "at.h1", rest=False)
        live.page.wait_for_selector(f".point.old .wrong:has-text('{said}'):not(:empty)")
        live.at_rest()
        assert field.get_attribute("aria-invalid") == "true"
        assert live.page.eval_on_selector(".point .verdict", "e => getComputedStyle(e).opacity") == "0.38"
    assert live.page.get_attribute(".point .wrong span", "lang") == "en"
    live.put("1,5", "at.h1", rest=False)
    live.page.wait_for_selector(".point:not(.old)")
    live.at_rest()
    assert "h1 = 1,5" in live.page.inner_text(".point .verdict")


def test_one_parameter_is_scrubbed(opened: Callable[..., Opened]) -> None:
    live = opened(LOCUS)  # stable exactly for 0 < k < 6
    for value, expected in (("6", "boundary"), ("5", "stable"), ("7", "unstable")):
        live.put(value, "at.k")
        assert live.page.get_attribute(".point .verdict", "data-verdict") == expected
    assert live.page.locator(".map .root").count() == 3
    live.page.focus(".scrub")
    live.page.keyboard.press("Home")
    live.at_rest()
    assert live.page.get_attribute(".point .verdict", "data-verdict") == "unstable"


def test_a_page_is_given_up_for_a_newer_question(opened: Callable[..., Opened]) -> None:
    live = opened(PAIR)
    live.page.wait_for_selector(".html math")
    pages = [ask for ask in live.asked if ask["want"] == "page"]
    assert pages
    x, y = live.middle("observer_poles.0")
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    live.page.mouse.move(x - 40, y)
    live.page.wait_for_timeout(900)
    assert [ask for ask in live.asked if ask["want"] == "page"] == pages  # none while a handle is held
    with live.page.expect_request(lambda request: '"want":"page"' in (request.post_data or "")):
        live.page.mouse.up()


def test_a_derivation_that_is_not_decided_can_be_asked_for_again(
    opened: Callable[..., Opened], server: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    usual, hasty = server.children.answer, Children(AnswerBudget(0, 1000))

    def answered(body: bytes, has_left: Callable[[], bool]) -> bytes:
        return (hasty.answer if json.loads(body)["want"] == "page" else usual)(body, has_left)

    monkeypatch.setattr(server.children, "answer", answered)
    live = opened(PAIR)
    live.page.wait_for_selector(".html:has-text('not decided within 0 s')")
    assert live.latex("K") == r"K=\begin{bmatrix}4&3\end{bmatrix}"
    monkeypatch.undo()
    live.page.click("text=Try again")
    live.page.wait_for_selector(".html math")
    hasty.close()


def test_a_link_opens_the_same_and_back_undoes(opened: Callable[..., Opened]) -> None:
    live = opened(PAIR)
    assert "token" not in live.page.url
    x, y = live.middle("observer_poles.0")
    live.drag((x, y), (x - 60, y))
    live.at_rest()
    moved = live.poles("observer_poles")
    live.page.get_by_label("Detail").select_option("answer")
    live.at_rest()
    live.page.click(".copy")
    link = live.page.evaluate("navigator.clipboard.readText()")
    assert "token" not in link
    other = opened(re.sub(r"%(..)", lambda c: chr(int(c[1], 16)), link.partition("#")[2]))
    assert other.poles("observer_poles") == moved
    assert other.latex("L") == live.latex("L")
    other.page.wait_for_selector(".html math")
    assert other.page.inner_text(".html") == live.page.inner_text(".html")
    tab = live.context.new_page()
    tab.goto(link)
    tab.wait_for_selector(".card math")
    assert tab.input_value('[data-set="observer_poles"]') == moved
    tab.evaluate("document.querySelector('main').dataset.share = 'https://example.org/live/'")
    tab.click(".copy")
    assert tab.evaluate("navigator.clipboard.readText()") == f"https://example.org/live/#{link.partition('#')[2]}"
    live.page.go_back()
    live.page.go_back()
    live.at_rest()
    assert live.poles("observer_poles") == "-5+5/2i, -5-5/2i"


#: What is wider than its place, and cannot be scrolled by the keyboard.
_OUT_OF_REACH = (
    "[...document.querySelectorAll('.display')].filter(e => e.scrollWidth > e.clientWidth && e.tabIndex < 0)"
)


def test_margins_follow_the_poles(opened: Callable[..., Opened]) -> None:
    live = opened(f"{SERVO}&closed=page&goal=phase:45,overshoot:10&step=1")
    met = live.page.locator("b.met")
    # independent numbers of F = (319 s + 400)/(s² + 23 s + 161) and of F = (1751 s + 4100)/(4 s² + 92 s + 669)
    assert "11.1723, phase margin ≈ 67.798235°" in live.page.inner_text(".loop")
    assert live.page.locator(".loop path.curve").count() == 4
    live.put("-2+5/2j, -2-5/2j", "control_poles")
    assert "phase margin ≈ 46.741191°" in live.page.inner_text(".loop")
    assert met.evaluate_all("all => all.map(e => e.dataset.met)") == [
        "false",
        "true",
        "true",
    ]  # 24 % with the zero of F; the plant integrates
    live.page.get_by_role("button", name="Close Frequency response").click()
    assert "closed=page,loop" in unquote(live.page.url)


def test_an_answer_shows_its_line_in_the_derivation(opened: Callable[..., Opened]) -> None:
    live = opened(SERVO)
    live.wait_for("document.querySelector('.html math')")
    live.page.click('.card[data-name="L"]')
    seen = "[...document.querySelectorAll('.html details[open] math')].filter(m => m.getBoundingClientRect().height).length"
    assert live.page.evaluate(seen) == 0  # the outline is closed
    live.page.get_by_role("button", name="Show the line of L in the derivation").click()
    assert live.page.evaluate(seen) > 0
    live.wait_for("document.getAnimations().length === 1")
    marked = live.page.evaluate("document.getAnimations()[0].effect.target.textContent")
    assert live.page.text_content('.card[data-name="L"] math') in marked


_CONTRAST = """() => {
  const rgb = c => { const d = document.createElement('canvas').getContext('2d'); d.fillStyle = c; d.fillRect(0, 0, 1, 1);
    return [...d.getImageData(0, 0, 1, 1).data].slice(0, 3); };
  const light = c => { const [r, g, b] = rgb(c).map(v => (v /= 255) <= .03928 ? v / 12.92 : ((v + .055) / 1.055) ** 2.4);
    return .2126 * r + .7152 * g + .0722 * b; };
  const style = getComputedStyle(document.querySelector('.symobs-live')), of = n => light(style.getPropertyValue(n));
  return ['--ink', '--control', '--observer', '--pale', '--bad', '--good', '--c0', '--c1', '--c2', '--c3'].flatMap(n =>
    ['--paper', '--back', '--ground'].map(b => { const [x, y] = [of(n), of(b)].sort((p, q) => q - p);
      return [n + ' on ' + b, (x + .05) / (y + .05)]; }));
}"""


@pytest.mark.parametrize(
    "state",
    [f"{PAIR}&language=de", CASES, REGION, f"{SERVO}&closed=none&goal=phase:45,gain:100"],
    ids=["poles", "cases", "region", "loop"],
)
def test_nothing_overflows_and_every_colour_can_be_read(opened: Callable[..., Opened], state: str) -> None:
    live = opened(state)
    live.wait_for("document.querySelector('.html math')")
    for width, scheme in ((320, "light"), (1180, "dark")):
        live.page.emulate_media(media="screen", color_scheme=scheme, forced_colors="none")
        live.page.set_viewport_size({"width": width, "height": 800})
        live.page.wait_for_timeout(200)
        assert live.page.evaluate("document.documentElement.scrollWidth") <= width
        live.wait_for(f"!({_OUT_OF_REACH}).length")
        assert {name: ratio for name, ratio in live.page.evaluate(_CONTRAST) if ratio < 4.5} == {}
        for media, forced in (("print", "none"), ("screen", "active")):
            live.page.emulate_media(media=media, forced_colors=forced)
            assert len(set(live.page.screenshot())) > 200


def test_markup_of_a_user_does_nothing(opened: Callable[..., Opened]) -> None:
    hostile = '<img src=x onerror="document.title=1">'
    live = opened(SERVO)
    live.put(hostile, "A row 1 column 1", rest=False)
    live.page.wait_for_selector(".symobs-live.stale")
    assert live.page.title() == "symobs live"
    assert live.page.locator("img").count() == 0
    refused = live.page.evaluate("(() => { try { return eval('1 + 1'); } catch (error) { return error.name; } })()")
    assert refused in {"EvalError", 2}  # the tool's own script may be excepted; a script of the page is not
    live.page.evaluate(
        "const s = document.createElement('script'); s.textContent = 'document.title = 2'; document.body.append(s)"
    )
    assert live.page.title() == "symobs live"
    live.complaints[:] = [each for each in live.complaints if "Content Security Policy" not in each]


def test_what_cannot_be_seen_is_said_at_rest_only(opened: Callable[..., Opened]) -> None:
    live = opened(PAIR)
    live.wait_for("document.querySelector('[aria-live]').textContent.includes('K equals')")
    assert live.page.locator("[aria-live]").count() == 1
    x, y = live.middle("observer_poles.0")
    before = live.page.inner_text("[aria-live]")
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    live.page.mouse.move(x - 50, y)
    live.page.wait_for_timeout(1200)
    assert live.page.inner_text("[aria-live]") == before
    live.page.mouse.up()


def test_a_server_that_is_gone_is_said_and_the_state_stays(chromium: Any) -> None:
    run = subprocess.Popen(
        [sys.executable, "-m", "symobs", "serve", "--no-browser"],
        env=environment(),
        stdout=subprocess.PIPE,
        text=True,
    )
    assert run.stdout is not None
    url = run.stdout.readline().strip()
    context = chromium.new_context()
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    page.goto(url)
    page.wait_for_selector(".card math")
    run.kill()
    run.wait()
    run.stdout.close()
    page.fill('[data-set="control_poles"]', "-3, -3")
    page.press('[data-set="control_poles"]', "Tab")
    page.wait_for_selector(".message:not([hidden])")
    assert "Try again" in page.inner_text(".message")
    assert page.input_value('[data-set="control_poles"]') == "-3, -3"
    context.close()
