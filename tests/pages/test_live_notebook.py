"""The widget of notebooks: what it answers without a browser, and two of them in the shadow roots of one page."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.applications.live import answer
from symobs.ground.errors import ProblemErrors, UsageError
from tests.support.tools.command_line import SERVO, inside

if TYPE_CHECKING:
    from collections.abc import Callable

pytestmark = pytest.mark.slow  # the extra `notebook` is not among those of the quick tests
ASK = {"schema": "symobs-live/1", "id": 1}
PLANT = {"A": "[0 1; 0 -1]", "B": "[0; 1]", "C": "[1 0]"}
#: A page with two widgets in shadow roots, as marimo has them, and the model that a notebook would give them.
PAGE = """
<!doctype html><meta charset="utf-8"><title>notebook</title><div id="one"></div><div id="two"></div>
<script type="module">
const code = URL.createObjectURL(new Blob([window.module], { type: "text/javascript" }));
const widget = (await import(code)).default;
class Model {
  constructor(name, state) { Object.assign(this, { name, values: { state }, heard: new Map() }); }
  get(key) { return this.values[key]; }
  set(key, value) { this.values[key] = value; }
  save_changes() { window.kept(this.name, this.values.state); }
  on(event, f) { this.heard.set(event, [...(this.heard.get(event) ?? []), f]); }
  off(event, f) { this.heard.set(event, (this.heard.get(event) ?? []).filter((g) => g !== f)); }
  fire(event, ...content) { for (const f of this.heard.get(event) ?? []) f(...content); }
  async send(content) {
    for (const told of JSON.parse(await window.kernel(this.name, JSON.stringify(content)))) this.fire("msg:custom", told);
  }
}
window.models = {};
for (const [name, state] of Object.entries(window.states)) {
  const root = document.getElementById(name).attachShadow({ mode: "open" }), el = document.createElement("div");
  root.append(Object.assign(document.createElement("style"), { textContent: window.css }), el);
  window.models[name] = new Model(name, state);
  window.models[name].end = widget.render({ model: window.models[name], el });
}
</script>
"""


@pytest.fixture(name="widget")
def made() -> Callable[..., Any]:
    """Make a widget whose messages are kept."""
    pytest.importorskip("anywidget", reason="needs anywidget: pip install symobs[notebook]")

    def make(*arguments: Any, **keywords: Any) -> Any:
        found = symobs.live(*arguments, **keywords)
        found.sent = []
        found.send = lambda content, buffers=None: found.sent.append(content)  # noqa: ARG005 - as the widget has it
        return found

    return make


def ask(widget: Any, body: object) -> Any:
    """What the kernel sends back; the message comes as the comm hands it on."""
    widget._handle_custom_msg({"id": "a", "body": body}, [])
    assert widget.sent[-1]["id"] == "a"
    return widget.sent.pop()["body"]


def servo(poles: str) -> dict[str, Any]:
    return {"task": "observer", "plant": PLANT, "specification": {"poles": poles}, "symbols": {}}


def test_the_kernel_answers_what_the_server_answers(widget: Callable[..., Any]) -> None:
    live = widget(servo("-10, -10"))
    for want in ("start", "view", "answer", "page", "export"):
        body = {**ASK, "want": want, "problem": servo("-4, -5")}
        told = ask(live, body)
        assert told["status"] == "done"
        assert told == answer(body)
        json.dumps(told)
    assert live.sent == []


def test_the_result_is_that_of_the_newest_answer(widget: Callable[..., Any]) -> None:
    live = widget(plant=symobs.StateSpace(*PLANT.values()), task="observer", poles=[-10, "-10"])
    seen: list[Any] = []
    live.on_change(seen.append)
    gain = [Fraction(19), Fraction(81)]  # (s + 1 − ...) by hand: l₁ = 20 − 1, l₂ = 100 − l₁
    assert [Fraction(str(entry)) for entry in live.result.L] == gain
    ask(live, {**ASK, "want": "page", "problem": servo("-4, -5")})
    ask(live, {**ASK, "problem": servo("-4, q")})  # bad: the result stays
    assert ([Fraction(str(entry)) for entry in live.result.L], seen) == (gain, [])
    ask(live, {**ASK, "problem": servo("-4, -5")})
    assert [str(entry) for entry in live.result.L] == ["8", "12"]  # 9 − 1, 20 − 8
    assert seen == [live.result]


def test_the_state_is_that_of_a_link(widget: Callable[..., Any]) -> None:
    from symobs.applications.live.request import link_of  # noqa: PLC0415 - beside anywidget, which may be missing

    plant = symobs.StateSpace("[0 1; -omega^2 0]", None, "[1 0]", symbols={"omega": "positive"})
    live = widget(plant=plant, task="observer", poles="-1, -2")
    assert live.state == "v=1&task=observer&A=[0%201;%20-omega^2%200]&C=[1%200]&poles=-1,%20-2&symbols=omega:positive"
    assert widget(SERVO).state == widget(str(SERVO)).state == widget(SERVO.read_text("utf-8")).state
    assert widget(servo("-1, -2")).state == link_of(servo("-1, -2"))


def test_where_there_is_no_kernel_the_derivation_is_shown(widget: Callable[..., Any]) -> None:
    live = widget(SERVO)
    data, _ = live._repr_mimebundle_()
    assert set(data) == {"text/plain", "text/html", "application/vnd.jupyter.widget-view+json"}
    assert data["text/html"] == inside("solve", str(SERVO), "--format", "html_fragment").out
    assert "<math" in data["text/html"]
    assert "<script" not in data["text/html"]


@pytest.mark.parametrize(
    ("arguments", "keywords", "kind", "reason"),
    [
        ((), {}, UsageError, 'task: nothing is asked; write for example task="observer"'),
        ((servo("-1, -2"),), {"task": "observer"}, UsageError, "problem: a problem file says all of it"),
        ((servo("-1, q"),), {}, ProblemErrors, 'the name "q" is not declared'),
        (("none.toml",), {}, symobs.InputError, "none.toml"),
        ((), {"task": "observer", "poles": [-1]}, ProblemErrors, "plant.A: the state matrix is missing"),
    ],
)
def test_what_is_wrong_is_said_at_once(
    widget: Callable[..., Any], arguments: Any, keywords: Any, kind: type[Exception], reason: str
) -> None:
    with pytest.raises(kind) as refused:
        widget(*arguments, **keywords)
    assert reason in str(refused.value)


def test_two_widgets_in_shadow_roots(chromium: Any, widget: Callable[..., Any]) -> None:
    live = {"one": widget(SERVO), "two": widget(servo("-4, -5"))}

    def kernel(name: str, content: str) -> str:
        live[name]._handle_custom_msg(json.loads(content), [])
        told, live[name].sent = live[name].sent, []
        return json.dumps(told)

    page = chromium.new_page(viewport={"width": 900, "height": 900})
    page.set_default_timeout(60_000)
    complaints: list[str] = []
    page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.expose_function("kernel", kernel)
    page.expose_function("kept", lambda name, state: setattr(live[name], "state", state))
    given = {"module": live["one"]._esm, "css": live["one"]._css, "states": {n: w.state for n, w in live.items()}}
    page.add_init_script("".join(f"window.{name} = {json.dumps(value)};" for name, value in given.items()))
    page.route("http://notebook.test/", lambda route: route.fulfill(body=PAGE, content_type="text/html"))
    page.goto("http://notebook.test/")
    assert (
        page.get_attribute('#one .card[data-name="K"] [data-latex]', "data-latex")
        == r"K=\begin{bmatrix}4&3\end{bmatrix}"
    )
    gain = '#two .card[data-name="L"] [data-latex]'
    assert page.get_attribute(gain, "data-latex") == r"L=\begin{bmatrix}8\\12\end{bmatrix}"
    page.fill('#two [data-set="poles"]', "-2, -3")
    page.press('#two [data-set="poles"]', "Tab")
    page.wait_for_selector('#two .card[data-name="L"] [data-latex*="4"]')  # 5 − 1, 6 − 4
    assert [str(entry) for entry in live["two"].result.L] == ["4", "2"]
    assert "poles=-2,%20-3" in live["two"].state
    assert "control=-2,%20-2" in live["one"].state
    page.evaluate(
        """() => {
            const model = window.models.one;
            model.values.state = model.values.state.replace("control=-2,%20-2", "control=-3,%20-3");
            model.fire("change:state");
        }"""
    )
    page.wait_for_selector('#one .card[data-name="K"] [data-latex*="9&5"]')  # (s + 3)²: 9, 6 − 1
    assert (
        page.evaluate(
            "getComputedStyle(document.getElementById('two').shadowRoot.querySelector('.panel')).borderRadius"
        )
        == "10px"
    )
    assert page.evaluate("document.documentElement.scrollWidth") <= 900
    page.evaluate("() => { for (const m of Object.values(window.models)) m.end(); }")
    assert page.locator(".symobs-live").count() == 0
    page.close()
    assert complaints == []
