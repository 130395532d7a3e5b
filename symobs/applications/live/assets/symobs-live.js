// @ts-check
// The front-end of symobs live: it draws what it is told and computes no mathematics. A pointer is snapped to a grid of
// rationals and sent as exact text; whatever is shown came from Python, where it was checked.

import { cells, handles, imaginary, matrix, numberOf, parts, plus, poles, ratio, rational, settled, text, value, written } from "./numbers.js";
import { DETAILS, PANELS, PLANT, SNAPS, decoded, encoded } from "./link.js";
import { PLUS, SUB, h, sv, ticks } from "./elements.js";
import { drawCurves, drawLoop } from "./curves.js";

const SCHEMA = "symobs-live/1", GRID = 20, REST = 250, BUSY = 150, LONGEST = 8000;
const GOALS = ["settling", "overshoot", "gain", "phase"], MOST_PINNED = 3;

/** The words of each language by its code; whoever hands out this file puts them in. @type {Record<string, Record<string, string>>} */
export const LANGUAGES = {};

let mounted = 0;

/** Put what a phrase speaks of into its slots. @param {string} phrase @param {object} slots */
export const filled = (phrase, slots) => phrase.replace(/\{(\w+)\}/g, (_, slot) => slots[slot]);

/** Post questions to the server of `symobs serve`. @param {string} token */
export const http = (token) => async (body, signal) => {
  const headers = { "Content-Type": "application/json", "X-Symobs-Token": token };
  const got = await fetch("api", { method: "POST", headers, body: JSON.stringify(body), signal });
  if (!got.ok) throw Object.assign(new Error(), { status: got.status });
  return got.json();
};

const DEMO = "v=1&task=compensator&A=[0 1; 0 -1]&B=[0; 1]&C=[1 0]&control=-2, -2&observer=-10, -10";

/**
 * Show a problem in an element, and ask `transport` what is true of it.
 * @param {HTMLElement} element
 * @param {(body: object, signal?: AbortSignal) => Promise<any>} transport
 * @param {{state?: string, changed?: (state: string, final: boolean) => void, link?: (state: string) => string}} options
 */
export function mount(element, transport, options = {}) {
  const root = h("div", { class: "symobs-live" });
  element.append(root);
  const begun = (link) => decoded(/(^|[#&])task=/.test(link) ? link : `${DEMO}&${link.replace(/^#/, "")}`);
  let s = begun(options.state ?? "");
  let view = null, viewed = "", answer = null, sets = {}, held = null, frame = null, start = null;
  let waiting = null, running = false, number = 0, drawn = 0, restTimer = 0, busyTimer = 0, said = 0, renewing = false, gone = false, quiet = false, before = "";
  let aborted = new AbortController(), language = null, notice = "", point = null, pinned = [], turns = 0, turning = 0, isLetGo = false, fill = () => {}, release = () => {};
  const unfolded = new Set();
  const unentered = new Map();  // fields whose text belongs to no question: it is being typed, or it was refused
  let traced = null;  // the answer whose line is shown as soon as there is a derivation
  let origin = encoded(s), steps = [origin], reached = 0;
  const el = {}, focused = () => root.getRootNode().activeElement, find = (name, of = "where") => root.querySelector(`[data-${of}="${CSS.escape(name)}"]`);

  const w = (name, slots = {}) => filled(language[name], slots);
  const pretty = (s) => s.replace(/(?<!\p{L}{2})-|-(?!\p{L}{2})/gu, "−").replace(/(\d)\.(?=\d)/g, `$1${language.decimal_mark}`);
  const page = { el, w, pretty };
  const taskName = (task) => language[`task_${task}`] ?? task.replace(/_/g, " ");
  const labelOf = (key) => language[`field_${key}`] ?? key.replace(/_/g, " ");
  const why = (error) => (error.status ? w(error.status === 403 ? "another_page" : "server_says", error) : error.message);

  // -- the frame of the page --

  const panel = (name, ...inside) => {
    const label = w("close", { panel: w(name) }), close = h("button", { class: "quiet", title: label, "aria-label": label, onclick: () => fold(name, true) }, "×");
    return (el[name] = h("section", { class: `panel ${name}`, "aria-label": w(name) }, h("header", {}, h("h2", {}, w(name)), (el[`${name}Bar`] = h("span", { class: "tools" })), close), (el[`${name}Body`] = h("div", { class: "body" }, inside))));
  };

  /** Build the frame where there is none in the language of the state, and return whether there was none. */
  function furnish() {
    const stranger = s.language in LANGUAGES ? "" : s.language;
    if (stranger) s.language = language ? root.lang : "";
    const code = s.language || "en", derivation = el.html ? [...el.html.childNodes] : [];
    if (language !== LANGUAGES[code] || stranger) notice = "";
    if (language === LANGUAGES[code] && !stranger) return false;
    language = LANGUAGES[code];
    root.lang = code;
    if (stranger) notice = w("no_language", { code: stranger.slice(0, 40) });
    el.task = h("select", { "aria-label": w("task"), onchange: () => turn(el.task.value) }, h("option", { value: s.task }, taskName(s.task)));
    el.titles = h("datalist", { id: `symobs-examples-${(mounted += 1)}` });
    el.examples = h("input", { list: el.titles.id, "aria-label": w("example"), placeholder: w("examples"), autocomplete: "off", oninput: choose });
    el.language = h("select", { "aria-label": w("language"), onchange: () => { s.language = el.language.value; commit(true); build(); ask(); el.language.focus(); } }, Object.entries(LANGUAGES).map(([key, own]) => h("option", { value: key, lang: key, selected: key === code }, own.name)));
    el.snap = h("select", { title: w("grid_of_poles"), onchange: () => { s.snap = el.snap.value; commit(true); drawPlane(); } }, Object.keys(SNAPS).map((k) => h("option", { value: k }, k)));
    el.message = h("div", { class: "message", hidden: true });
    for (const name of ["list", "map", "point"]) el[name] = h("div", { class: name });
    for (const name of ["verdict", "notes", "legend", "marks", "met", "hint"]) el[name] = h("p", { class: name });
    el.hint.textContent = w("drag");
    el.pins = h("div", { class: "pins" });
    el.live = h("div", { class: "hidden", "aria-live": "polite", role: "status" });
    el.poles = sv("svg", { class: "picture", viewBox: "0 0 480 360", role: "group", "aria-label": w("plane_of_poles") });
    el.texts = h("div", { class: "fields" });
    el.curves = sv("svg", { class: "picture", viewBox: "0 0 480 300", role: "img", "aria-label": w("responses") });
    for (const name of ["effort", "magnitude", "phase", "locus"]) el[name] = sv("svg", { class: "picture effort", viewBox: "0 0 480 300", role: "img", "aria-label": w(name) });
    for (const name of ["efforts", "margins", "magnitudes", "phases", "loci"]) el[name] = h("p", { class: "legend" });
    el.goals = h("div", { class: "fields" });
    el.required = h("details", { class: "goals", open: Object.keys(s.goal).length > 0 }, h("summary", {}, w("goals")), el.goals);
    el.starts = h("div", { class: "fields starts" });
    el.html = h("div", { class: "html", tabindex: "0", "aria-label": w("page") }, derivation);
    el.plant = h("section", { class: "panel plant", "aria-label": w("problem") });
    el.reopen = h("span", { class: "reopen" });
    const button = (name, sign, act) => (el[name] = h("button", { class: "quiet", title: w(name), "aria-label": w(name), onclick: act }, sign));
    el.copy = h("button", { class: "copy", onclick: () => copy(options.link ? options.link(encoded(s)) : encoded(s), el.copy, w("copy_link")) }, w("copy_link"));
    const save = ["toml", "python", "latex", "html"].map((as) => h("button", { onclick: () => take(as) }, w(`save_${as}`)));
    root.replaceChildren(
      h("header", { class: "bar" }, h("h1", {}, "symobs"), el.task, el.examples, el.titles, button("undo", "↶", () => walk(-1)), button("redo", "↷", () => walk(1)), button("reset", "⟲", () => shift(origin)), el.reopen, h("span", { class: "space" }), el.language, el.copy, h("details", { class: "menu" }, h("summary", {}, w("save")), h("div", {}, save))),
      el.message,
      h("div", { class: "grid" }, el.plant, panel("region", el.map, el.point), panel("plane", el.met, el.poles, el.marks, el.texts, el.required, el.hint), panel("responses", el.curves, el.legend, el.effort, el.efforts, el.starts), panel("loop", el.margins, [[el.magnitude, el.magnitudes], [el.phase, el.phases], [el.locus, el.loci]].map((each) => h("div", {}, each))), panel("cases"), panel("cards", el.verdict, el.notes, el.list, el.pins), panel("page", el.html)),
      el.live,
    );
    el.drive = h("select", { "aria-label": w("drive"), onchange: () => { s.step = el.drive.value; settle(); } }, [["", "drive_state"], ["1", "drive_step"]].map(([value, word]) => h("option", { value }, w(word))));
    el.responsesBar.append(el.drive);
    el.pin = h("button", { class: "quiet", onclick: pin }, w("pin"));
    el.convention = h("button", { class: "quiet", "data-where": "convention", title: w("standard_convention"), onclick: () => { s.convention = ""; problemChanged(); el.pin.focus(); } });
    el.cardsBar.append(el.convention, el.pin);
    drawPins();
    el.gains = h("span", {});
    el.planeBar.append(el.gains, h("label", {}, `${w("grid")} `, el.snap));
    el.detail = h("select", { "aria-label": w("detail"), onchange: () => { s.detail = el.detail.value; commit(true); rest(0); } }, DETAILS.map((d) => h("option", { value: d }, w(`detail_${d}`))));
    el.pageBar.append(el.detail);
    offer();
    drawSteps();
    say("");
    return true;
  }

  function fold(name, close) {
    s.closed = close ? [...new Set([...s.closed, name])] : s.closed.filter((n) => n !== name);
    commit(true);
    showPanels();
    if (!close) ask();
  }

  function showPanels() {
    const known = view?.panels ?? ["cards"];
    for (const name of PANELS) el[name].hidden = !known.includes(name) || s.closed.includes(name);
    el.reopen.replaceChildren(...known.filter((n) => s.closed.includes(n)).map((n) => h("button", { class: "quiet", onclick: () => fold(n, false) }, `+ ${w(n)}`)));
    root.dataset.task = s.task;
  }

  // -- asking: one question under way, the newest waits --

  const filledIn = (fields) => Object.fromEntries(Object.entries(fields).filter(([, entry]) => entry !== ""));  // an empty one says nothing
  const problem = () => {
    const told = { task: s.task, plant: filledIn(s.plant), specification: filledIn(s.spec), symbols: s.symbols };
    if (/^\d+$/.test(s.plant.dt ?? "")) told.plant.dt = Number(s.plant.dt);
    if (s.plant.dt === "true") told.plant.dt = true;
    if (!Object.keys(told.plant).length) delete told.plant;
    if (told.specification.parameters) told.specification.parameters = parts(told.specification.parameters);
    for (const key of ["convention", "language"]) if (s[key]) told[key] = s[key];
    return told;
  };
  const isRegion = () => s.task === "stability_region" || s.task === "root_locus";
  const signature = () => JSON.stringify([s.task, s.plant, s.symbols, s.convention, s.language, isRegion() ? [s.spec, free()] : Object.keys(s.spec)]);
  const isStep = () => Boolean(s.step && view?.step);
  const axes = () => (isRegion() ? view?.region?.parameters ?? Object.keys(s.at) : []);
  const free = () => Object.fromEntries(Object.entries(s.at).filter(([name]) => !axes().includes(name)));

  // Whatever is shown carries the question that it answers: it is pale while the fields and handles say another.
  const questions = { answer: () => [problem(), free(), s.x0, s.xh0, isStep(), s.goal], region: () => [problem(), free()], point: () => [problem(), s.at], page: () => [problem(), free(), s.detail] };
  const answered = {};
  const question = (kind) => JSON.stringify(questions[kind]());
  const isOld = (kind) => unentered.size > 0 || answered[kind] !== question(kind);
  function fade() {
    root.classList.toggle("stale", isOld("answer"));
    el.map.classList.toggle("old", isOld("region"));
    el.point.classList.toggle("old", isOld("region") || isOld("point"));
    el.page.classList.toggle("old", isOld("page"));
    el.plane.inert = view && view.task !== s.task;  // they would move what the problem on the screen does not have
    el.region.inert = signature() !== viewed;
  }

  const asking = (want, more = {}) => ({ schema: SCHEMA, id: ++number, want, problem: problem(), ...more });

  function ask() {
    waiting = true;
    aborted.abort();
    el.page.setAttribute("aria-busy", "false");
    clearTimeout(restTimer);
    fade();
    if (!running) run();
  }

  async function run() {
    running = true;
    clearTimeout(busyTimer);
    busyTimer = setTimeout(() => busy(true), BUSY);
    while (waiting && !gone) {
      waiting = null;
      const moving = held !== null;
      try {
        if (signature() !== viewed) {
          const mark = signature(), asked = question("region"), got = await transport(asking("view", isRegion() ? { at: free() } : {}));
          if (got.status !== "done") { drawAnswer(got); continue; }
          view = got.view;
          viewed = mark;
          answered.region = asked;
          takeView();
          if (signature() !== viewed) waiting = true;  // the picture has other axes than the one before
          if (waiting) continue;
        }
        const region = view.panels.includes("region") && view.region?.handle && Object.keys(s.at).length;
        if (region) {
          const asked = question("point"), got = await transport(asking("point", { at: { ...view.region.drawn_for, ...s.at } }));
          drawPoint(got, asked);
          if (waiting || moving || got.status !== "done") continue;
        }
        const at = free(), courses = open("responses") ? { start: s.x0, estimate: s.xh0, step: isStep(), end: null, count: 129 } : undefined;
        const more = { at, moving, goal: s.goal, cards_at: Object.keys(at).length > 0, cases: !moving && open("cases"), loop: open("loop") ? (moving ? "moving" : "rest") : "none" };
        if (courses) more.courses = courses;
        const asked = question("answer"), got = await transport(asking("answer", more));
        if (got.id >= drawn || !got.id) drawAnswer(got, asked);
      } catch (error) {
        if (!gone) say(w("no_answer", { reason: why(error) }), () => ask());
      }
    }
    running = false;
    clearTimeout(busyTimer);
    busy(turning > 0);
    rest(REST);
  }

  const open = (name) => view?.panels.includes(name) && !s.closed.includes(name);
  const busy = (is) => { root.classList.toggle("busy", is); root.setAttribute("aria-busy", String(is)); };

  /** What there is to choose from: asked when the first answer stands, for whatever loads it takes its time. */
  async function learn() {
    const got = await transport({ schema: SCHEMA, id: ++number, want: "start" }).catch(() => null);
    if (!got?.tasks || start) return;
    start = got;
    offer();
  }

  function offer() {
    if (!start) return;
    fill();
    el.task.replaceChildren(...Object.keys(start.tasks).map((name) => h("option", { value: name }, taskName(name))));
    el.task.value = s.task;
    el.titles.replaceChildren(...start.examples.map((e) => h("option", { value: e.title, lang: "en" }, taskName(e.task))));
  }

  function rest(after) {
    clearTimeout(restTimer);
    if (held || gone) return;
    restTimer = setTimeout(async () => {
      announce();
      reachable();
      if (!start) learn();
      if (!open("page") || running || isOld("answer") || (!isOld("page") && el.html.querySelector("math"))) return;
      aborted.abort();
      aborted = new AbortController();
      const signal = aborted.signal, at = free(), asked = question("page");
      el.page.setAttribute("aria-busy", "true");
      const inquiry = asking("page", { detail: s.detail, at, cards_at: Object.keys(at).length > 0 });
      const got = await transport(inquiry, signal).catch((error) => ({ status: "undecided", message: w("no_answer", { reason: why(error) }) }));
      if (signal.aborted || gone) return;  // a newer question has taken its place
      answered.page = asked;
      fade();
      if (got.html) {
        el.html.innerHTML = got.html;
        el.html.querySelectorAll("h3").forEach(folded);
        if (traced?.isConnected) trace(traced);
        traced = null;
      }
      else el.html.replaceChildren(h("p", { class: "pale" }, got.message ?? got.errors?.map((e) => e.message).join("; ") ?? w("no_derivation")), ...(got.status === "undecided" ? [h("button", { onclick: () => rest(0) }, w("try_again"))] : []));
      el.page.setAttribute("aria-busy", "false");
      reachable();
    }, after);
  }

  /** Fold what stands below a heading; what was opened before stays open. */
  function folded(heading) {
    const name = heading.textContent, part = h("details", { open: unfolded.has(name), ontoggle: () => { unfolded[part.open ? "add" : "delete"](name); reachable(); } });
    heading.replaceWith(part);
    while (part.nextSibling && !part.nextSibling.matches?.("h3, .references")) part.append(part.nextSibling);
    part.prepend(h("summary", {}, heading));
  }

  /** Show the line of the derivation that gives an answer: the last with its value, else the last with its name. */
  function trace(card) {
    if (!open("page")) fold("page", false);
    if (isOld("page")) { traced = card; return; }
    const told = card.querySelector("math").textContent, lines = [...el.html.querySelectorAll("math")];
    const line = lines.findLast((m) => m.textContent.includes(told)) ?? lines.findLast((m) => m.textContent.startsWith(told.replace(/=.*/, "="))) ?? el.page;
    for (let part = line; (part = part.parentNode.closest("details"));) part.open = true;
    line.scrollIntoView({ block: "center" });
    line.animate({ outline: ["3px solid", "3px solid transparent"] }, 2500);
  }

  /** Let the keyboard reach formulas that are wider than their place, to scroll them. */
  function reachable() {
    for (const each of root.querySelectorAll(".display")) if (each.scrollWidth > each.clientWidth) each.setAttribute("tabindex", "0"); else each.removeAttribute("tabindex");
  }

  function announce() {
    if (!answer?.cards || held !== null || isOld("answer") || Date.now() - said < 1000) return;
    said = Date.now();
    el.live.textContent = `${el.verdict.textContent}. ${answer.cards.filter((c) => /^[KLF]$/.test(c.name)).map((c) => c.says).join(". ")}`;
  }

  function say(now, again) {
    const words = now || notice;
    if (!words && el.message.hidden) return;
    el.message.hidden = !words;
    el.message.replaceChildren(...(words ? [h("span", {}, words), again ? h("button", { onclick: () => { say(""); again(); } }, w("try_again")) : ""] : []));
  }

  // -- changes --

  function commit(final) {
    fade();
    const link = encoded(s);
    if (link.length > LONGEST) say(w("too_long"));
    else options.changed?.(link, final);
    if (!final || link === steps[reached]) return;
    steps.splice(reached + 1, Infinity, link);
    reached += 1;
    drawSteps();
  }

  /** Go to a state; it is a step of its own unless it is one of those that were gone. */
  function shift(link) {
    turning = 0;
    s = begun(link);
    frame = null;
    commit(true);
    begin();
  }
  function walk(by) {
    if (steps[reached + by] === undefined) return;
    reached += by;
    shift(steps[reached]);
    drawSteps();
  }
  function drawSteps() {
    const idle = { undo: reached < 1, redo: reached > steps.length - 2, reset: steps[reached] === origin };
    for (const [name, is] of Object.entries(idle)) el[name].setAttribute("aria-disabled", String(is));
  }
  // Fields are built anew when the focus has reached the next one.
  function problemChanged() { settle(); setTimeout(() => gone || build()); }
  function settle() { commit(true); ask(); }

  function choose() {
    const found = start?.examples.find((e) => e.title === el.examples.value), { snap, closed, detail, language } = s;
    if (!found) return;
    turning = 0;
    s = { ...decoded(found.link), snap, closed, detail, language };
    view = null;
    viewed = "";
    el.examples.value = "";
    origin = encoded(s);
    problemChanged();
  }

  /** Turn to another task, which begins with what it takes of the problem and with what that lacks. */
  async function turn(task, resized = {}) {
    const told = problem(), mine = turning = ++turns;
    busy(true);
    try {
      const got = await transport(asking("begin", { task, problem: { ...told, plant: { ...told.plant, ...resized } } }));
      if (gone || turning !== mine) return;
      if (JSON.stringify(told) !== JSON.stringify(problem())) { turn(task, resized); return; }
      if (got.status !== "done") { drawAnswer(got); el.task.value = s.task; return; }
      const { plant, spec, symbols } = decoded(got.link);
      s = { ...s, task, plant, spec, symbols, at: Object.fromEntries(Object.entries(s.at).filter(([name]) => name in symbols)) };
      origin = encoded(s);
      problemChanged();
    } catch (error) {
      if (gone || turning !== mine) return;
      el.task.value = s.task;
      say(w("no_answer", { reason: why(error) }), () => turn(task, resized));
    } finally {
      if (turning === mine) turning = 0;
      if (!running && !turning) busy(false);
    }
  }

  async function copy(told, button, label) {
    try {
      await navigator.clipboard.writeText(told);
      button.textContent = w("copied");
      setTimeout(() => { button.textContent = label; }, 1500);
    } catch {
      const field = h("input", { value: told, "aria-label": label, readonly: true });
      el.message.hidden = false;
      el.message.replaceChildren(w("copy_this"), field);
      field.select();
    }
  }

  async function take(as) {
    try {
      const got = await transport(asking("export", { as, at: free(), cards_at: Object.keys(free()).length > 0 }));
      if (!got.text) throw new Error(got.message ?? got.errors?.[0]?.message ?? w("nothing_to_save"));
      const url = URL.createObjectURL(new Blob([got.text], { type: "text/plain" }));
      h("a", { href: url, download: got.file }).click();
      setTimeout(() => URL.revokeObjectURL(url), 1000);
    } catch (error) { say(w("not_saved", { reason: why(error) })); }
  }

  // -- the problem: matrices, specification, symbols --

  /** Hand on what was typed, with decimal points; a comma that may part entries or be a decimal mark is refused at its field. */
  function typed(input, changed) {
    const given = input.value.trim(), where = input.dataset.where ?? `specification.${input.dataset.set}`;
    const points = given.replace(/(\d),(?=\d)/g, "$1."), isOne = /^at\.|\]$/.test(where);
    const isParted = given.includes(";") && (input.dataset.set || where.startsWith("courses."));
    if (language.decimal_mark === "," && (isOne || isParted)) changed(input.value = points.replace(/\s*;\s*/g, ", "));
    else if (language.decimal_mark !== "," || points === given) changed(given);
    else { clearWrong(); unentered.set(nameOfField(input), "refused"); input.classList.add("typed"); showErrors([{ where, message: w("comma"), repair: w("comma_repair") }]); fade(); }
  }

  const nameOfField = (input) => input.dataset.where ?? input.dataset.set;

  /** Write into a field what is moved elsewhere, unless somebody types there. */
  function write(input, entry) {
    if (!input || (focused() === input && input.matches(".typed"))) return;
    unentered.delete(nameOfField(input));
    input.classList.remove("typed");
    input.value = entry;
  }

  /** A field for text, which is entered by Enter or by leaving the field, and taken back by Escape. */
  function textField(label, given, changed, of) {
    let entered = given ?? "";
    const name = Object.values(of)[0];
    const note = () => {
      if (input.value === entered) unentered.delete(name); else unentered.set(name, "typed");
      input.classList.toggle("typed", unentered.has(name));
      fade();
    };
    const enter = () => {
      unentered.delete(name);
      entered = input.value;
      input.classList.remove("typed");
      typed(input, changed);
    };
    const input = h("input", {
      value: entered, "aria-label": label, ...of, spellcheck: "false", autocapitalize: "off", autocomplete: "off",
      onfocus: () => { if (!unentered.has(name)) entered = input.value; }, oninput: note,
      onblur: () => { if (!renewing && unentered.get(name) === "typed") enter(); },
      onkeydown: (e) => {
        if (e.key === "Enter") enter();
        if (e.key !== "Escape" || !unentered.has(name)) return;
        input.value = entered;
        note();
        clearWrong();
        if (isOld("answer")) ask(); else rest(REST);
      },
    });
    return input;
  }

  function field(where, label, given, changed, wide = true) {
    const input = textField(label, given, changed, { "data-where": where });
    return wide ? labelled(label, input) : input;
  }

  const labelled = (label, input, mark = "", of = undefined) => h("div", { class: `field ${mark}` }, h("label", {}, h("span", {}, label), input), h("small", { class: "wrong", "data-of": of }));

  /** Do what builds fields anew; the focus stays where it is, and so does what is being typed. */
  function keepingFocus(renew) {
    const active = focused(), { where, set } = root.contains(active) ? active?.dataset ?? {} : {};
    renewing = true;
    renew();
    renewing = false;
    const again = where || set ? (where ? find(where) : find(set, "set")) : null;
    for (const name of [...unentered.keys()]) if (!(find(name) ?? find(name, "set"))?.matches(".typed")) unentered.delete(name);
    if (!again || again === active) return;
    again.focus({ preventScroll: true });
    if (active.type !== "text") return;
    if (active.matches(".typed")) {
      again.value = active.value;
      again.dispatchEvent(new Event("input"));
    }
    again.setSelectionRange(active.selectionStart, active.selectionEnd);
  }

  /** Hold nothing any more: what is held belongs to fields and pictures that are built anew. */
  function drop() {
    release();
    held = null;
    release = () => {};
  }

  function build() { drop(); keepingFocus(buildFields); }

  function buildFields() {
    const isFresh = furnish();
    const listed = ["A", "B", "C", "D"].filter((name) => s.plant[name] !== undefined);
    const rows = listed.map((name) => {
      const table = cells(s.plant[name]);
      const set = (t) => { s.plant[name] = t; problemChanged(); };
      if (!table) return field(`plant.${name}`, name, s.plant[name], set);
      const grid = h("span", { class: "matrix", style: `--columns:${table[0].length}` }, table.map((row, i) => row.map((cell, j) => {
        const size = Math.max(2, Math.min(14, Math.max(...table.map((r) => r[j].length))));
        const input = field(`plant.${name}[${i + 1},${j + 1}]`, w("entry", { name, row: i + 1, column: j + 1 }), cell, (t) => { if (t === table[i][j]) return; table[i][j] = t; set(matrix(table)); }, false);
        input.style.setProperty("--size", `${size}ch`);
        return input;
      })));
      return h("div", { class: "named" }, h("i", {}, name), " = ", grid, h("small", { class: "wrong", "data-of": `plant.${name}` }));
    });
    const told = (key) => field(`specification.${key}`, labelOf(key), s.spec[key], (t) => { if (t) s.spec[key] = t; else delete s.spec[key]; problemChanged(); });
    const setKeys = (view?.sets ?? []).map((g) => g.key);
    el.untold = h("div", { class: "fields" });
    fill = () => el.untold.replaceChildren(...(start?.tasks[s.task] ?? []).filter((key) => s.spec[key] === undefined && !setKeys.includes(key)).map(told));
    fill();
    const all = h("details", { class: "astext", open: el.plant.querySelector(".astext")?.open }, h("summary", {}, w("as_text")), h("div", { class: "fields" }, PLANT.map((name) => field(`text.${name}`, labelOf(name), s.plant[name], (t) => { if (t) s.plant[name] = t; else delete s.plant[name]; problemChanged(); })), field("text.symbols", labelOf("symbols"), Object.entries(s.symbols).map(([n, g]) => `${n}: ${g}`).join(", "), (t) => { s.symbols = Object.fromEntries(t.split(",").map((e) => e.split(":").map((p) => p.trim())).filter(([n]) => n).map(([n, g]) => [n, g || "real"])); problemChanged(); })), el.untold);
    const tables = Object.fromEntries(listed.map((name) => [name, cells(s.plant[name])]));
    const sizes = Object.entries({ states: tables.A?.length, inputs: tables.B?.[0]?.length, outputs: tables.C?.length }).filter(([, count]) => count).map(([kind, count]) => h("span", { class: "size" }, `${w(`count_${kind}`)} ${count} `, [[-1, "−"], [1, "+"]].map(([by, sign]) => h("button", { class: "quiet", "aria-label": w(by < 0 ? "fewer" : "more", { kind: w(`count_${kind}`) }), "data-where": `${kind}${by}`, "aria-disabled": String(count + by < 1), onclick: () => { if (count + by > 0 && !turning) resize(tables, kind, by); } }, sign))));
    if (s.plant.transfer_function !== undefined) rows.push(field("plant.transfer_function", "P(s)", s.plant.transfer_function, (t) => { s.plant.transfer_function = t; problemChanged(); }));
    const others = Object.keys(s.spec).filter((key) => ![...setKeys, ...given(), "observer"].includes(key)).map(told);
    const kind = s.task === "compensator" ? h("label", { class: "field" }, h("span", {}, w("kind")), h("select", { onchange: (e) => { s.spec.observer = e.target.value; fitObserver(); problemChanged(); } }, ["full", "minimal"].map((k) => h("option", { value: k, selected: (s.spec.observer ?? "full") === k }, w(`kind_${k}`))))) : null;
    const names = Object.keys(s.symbols).filter((n) => !axes().includes(n) || !view);
    const sliders = names.map((name) => slider(name, `at.${name}`, s.at[name] ?? "", (t) => { if (t) s.at[name] = t; else delete s.at[name]; return t; }, s.symbols[name]));
    el.plant.replaceChildren(h("header", {}, h("h2", {}, w("problem"))), h("div", { class: "body" }, h("div", { class: "matrices" }, rows), sizes.length ? h("div", { class: "sizes" }, sizes) : null, kind, others, sliders.length ? h("div", { class: "sliders" }, sliders) : null, all));
    if ([...el.task.options].some((o) => o.value === s.task)) el.task.value = s.task;
    el.snap.value = s.snap;
    el.detail.value = s.detail;
    el.pin.hidden = !view?.gains.length;
    el.convention.hidden = ["", "standard"].includes(s.convention);
    el.convention.textContent = `${w("convention", { name: s.convention })} ×`;
    el.drive.hidden = !view?.step;
    el.drive.value = isStep() ? "1" : "";
    buildSets();
    showPanels();
    if (!isFresh || !answer) return;
    if (view?.panels.includes("region")) drawMap();
    if (point && el.pointVerdict) drawPoint(point, answered.point);
    show(answer);
    fade();
  }

  /** Take away the last state, input or output, or add one: a state that drives the last one, an input or output of its own. */
  function resize(tables, kind, by) {
    const { A, B, C, D } = tables, unit = (size, k, entry) => Array.from({ length: size }, (_, j) => (j === k ? entry : "0"));
    const wider = (table, column) => table?.forEach((row, i) => { if (by < 0) row.pop(); else row.push(column[i] ?? "0"); });
    const taller = (table, row) => { if (by < 0) table?.pop(); else table?.push(row); };
    const n = A?.length ?? 0, m = B?.[0].length ?? 0, p = C?.length ?? 0;
    if (kind === "states") {
      wider(A, unit(n, n - 1, "1"));
      taller(A, unit(n + 1, n, "0"));
      taller(B, unit(m, m - 1, "1"));
      wider(C, unit(p, -1, "1"));
    } else if (kind === "inputs") {
      wider(B, unit(n, n - 1 - (m % n), "1"));
      wider(D, unit(p, -1, "1"));
    } else {
      taller(C, unit(n, p % n, "1"));
      taller(D, unit(m, -1, "1"));
    }
    turn(s.task, Object.fromEntries(Object.entries(tables).filter(([, table]) => table).map(([name, table]) => [name, matrix(table)])));
  }

  /** An observer of minimal order has fewer poles: drop the last ones, or repeat the first. */
  function fitObserver() {
    const rows = cells(s.plant.C ?? "")?.length ?? 1, order = cells(s.plant.A ?? "")?.length ?? 0;
    const wanted = order - (s.spec.observer === "minimal" ? rows : 0);
    const flat = handles(s.spec.observer_poles ?? "").flatMap((p) => (p.pair ? [{ re: p.re, im: [0, 1] }, { re: p.re, im: [0, 1] }] : [p]));
    if (flat.length === wanted || !flat.length) return;
    s.spec.observer_poles = Array.from({ length: wanted }, (_, k) => written(flat[Math.min(k, flat.length - 1)])).join(", ");
  }

  /** A slider and an exact value, of a letter or of an entry of a gain; `put` takes the value and returns what is kept. */
  function slider(name, where, given, put, sign = "real") {
    const far = Math.abs(numberOf(given)), most = far > 10 ? 2 * Math.ceil(far) : 10;
    const low = /positive|nonnegative/.test(sign) ? 0 : -most, high = /negative|nonpositive/.test(sign) && sign !== "nonnegative" ? 0 : most;
    const show = (t) => { if (rational(t)) range.value = String(numberOf(t) * GRID); };
    const set = (t, final) => { write(exact, put(t)); show(t); isLetGo ||= final; commit(final); ask(); };
    const range = h("input", { type: "range", min: low * GRID, max: high * GRID, "aria-label": `${name}, ${sign}`, "data-where": `move.${where}`, oninput: () => { held = "slider"; set(text(ratio(Number(range.value), GRID)), false); }, onchange: () => { held = null; isLetGo = true; settle(); } });
    show(given);
    const exact = field(where, w("value_of", { name }), given, (t) => set(t, true), false);
    exact.setAttribute("placeholder", view?.region?.drawn_for?.[name] ?? w("letter"));
    return h("div", { class: "slider" }, h("i", {}, name), range, exact, h("small", { class: "wrong", "data-of": where.replace(/\[.*/, "") }));
  }

  /** Let a gain be moved in the place of its poles, or these again. */
  function give(name) {
    if (!view || isOld("answer")) return;
    const group = view.sets.find((g) => g.gain === name);
    if (group) s.spec[name] = matrix(answer.result[name].map((row) => row.map((entry) => entry.replace(/\*\*/g, "^"))));
    delete s.spec[group?.key ?? name];
    if (group) problemChanged(); else turn(s.task);
  }

  function takeView() {
    if (held !== "slider") build();  // a slider that is held stays
    point = null;
    el.map.replaceChildren();
    if (view.panels.includes("region")) drawMap();
  }

  function drawMap() {
    const region = view.region;
    el.map.innerHTML = region?.svg ?? "";
    const svg = el.map.querySelector("svg");
    svg?.setAttribute("role", "group");  // it holds what can be moved
    svg?.setAttribute("aria-label", w("region"));
    if (region?.handle) {
      region.parameters.forEach((name, k) => { s.at[name] ??= region.handle[k]; });
      buildPoint();
    } else el.point.replaceChildren(h("p", { class: "pale" }, w("no_picture")));
  }

  // -- poles in their plane --

  /** The gains that are moved themselves. */
  const given = () => (view?.given ?? []).filter((name) => cells(s.spec[name] ?? ""));

  function entriesOf(name) {
    const table = cells(s.spec[name]);
    const label = (i, j) => `${name}${SUB(Math.min(table.length, table[0].length) < 2 ? i + j + 1 : `${i + 1}${j + 1}`)}`;
    return table.flatMap((row, i) => row.map((cell, j) => slider(label(i, j), `specification.${name}[${i + 1},${j + 1}]`, cell, (t) => {
      row[j] = t || "0";
      s.spec[name] = matrix(table);
      return row[j];
    })));
  }

  function buildSets() {
    sets = Object.fromEntries((view?.sets ?? []).map((group) => [group.key, handles(s.spec[group.key] ?? "")]));
    el.texts.replaceChildren(...(view?.sets ?? []).map((group) => labelled(w(`${group.label}s`), poleField(group), group.mark, `specification.${group.key}`)), ...given().flatMap(entriesOf));
    el.starts.replaceChildren(field("courses.start", "x(0)", s.x0 || "", (t) => { s.x0 = t; settle(); }), ...(s.task === "state_feedback" ? [] : [field("courses.estimate", "x̂(0)", s.xh0 || "", (t) => { s.xh0 = t; settle(); })]));
    for (const [input, fallback] of [[el.starts.querySelectorAll("input")[0], "1, 1, …"], [el.starts.querySelectorAll("input")[1], "0, 0, …"]]) input?.setAttribute("placeholder", fallback);
    el.goals.replaceChildren(...GOALS.filter((name) => name === "gain" || !view?.discrete).map((name) => field(`goal.${name}`, w(`goal_${name}`), s.goal[name], (t) => { if (t) s.goal[name] = t; else delete s.goal[name]; settle(); })));
    drawPlane(true);
  }

  const goalName = (name) => w(`goal_${answer?.goal?.[name]?.of ? `${name}_after_step` : name}`);
  const MET = { true: "✓", false: "✗" };

  /** Say above the plane which goals are met. */
  function drawGoals() {
    for (const name of GOALS) find(`goal.${name}`)?.closest(".field").querySelector("span").replaceChildren(goalName(name));
    keepingFocus(() => el.met.replaceChildren(...[...GOALS, "reference"].filter((name) => answer.goal?.[name]).map((name) => {
      const { met, value } = answer.goal[name];
      const others = name === "reference" && !met && s.task === "compensator" ? ["feedforward", "integral_action"] : [];
      return h("span", {}, `${goalName(name)}: ${pretty(s.goal[name] ?? "")} `, h("b", { class: "met", "data-met": String(met) }, `${value ? `(${pretty(value)}) ` : ""}${MET[met] ?? "○"}`, h("span", { class: "hidden" }, w({ true: "met", false: "missed" }[met] ?? "open"))), others.map((task) => h("button", { class: "quiet", "data-where": `reach.${task}`, onclick: () => turn(task) }, w("reached_by", { task: taskName(task) }))));
    })));
  }

  function poleField(group) {
    return textField(w(`${group.label}s`), s.spec[group.key], (t) => { s.spec[group.key] = t; sets[group.key] = handles(t); drawPlane(true); settle(); }, { "data-set": group.key });
  }

  function moved(final) {
    for (const key of Object.keys(sets)) {
      s.spec[key] = poles(sets[key]);
      const input = find(key, "set");
      write(input, s.spec[key]);
    }
    commit(final);
    drawPlane();
    ask();
  }

  function fit() {
    const xs = [0], ys = [1];
    const add = (re, im) => { xs.push(re); ys.push(Math.abs(im)); };
    Object.values(sets).flat().forEach((p) => p.raw || add(value(p.re), value(p.im)));
    (answer?.marks ?? []).forEach((m) => add(Number(m.re), Number(m.im)));
    if (view?.discrete) { add(1, 1); add(-1, 1); }
    const left = Math.min(...xs), right = Math.max(...xs), up = Math.max(...ys), width = 480 - 56, height = 360 - 40;
    const scale = Math.min(width / ((right - left) * 1.3 + 1), height / (2 * up * 1.35 + 0.4));
    frame = { scale, x: 40 + width / 2 - ((left + right) / 2) * scale, y: 16 + height / 2 };
  }
  const X = (x) => frame.x + x * frame.scale, Y = (y) => frame.y - y * frame.scale;

  function drawPlane(refit = false) {
    if (!view?.panels.includes("plane")) return;
    if (!frame || (refit && !held)) fit();
    const focus = focused()?.dataset.handle;
    const grounded = JSON.stringify([frame, view.discrete, root.lang]), parts = [];
    if (el.poles.firstChild?.dataset.of !== grounded) el.poles.replaceChildren(sv("g", { "data-of": grounded }, ground()));
    else while (el.poles.childElementCount > 1) el.poles.lastChild.remove();
    const line = (x1, y1, x2, y2) => parts.push(sv("line", { class: "goal", x1, y1, x2, y2 })), { settling, overshoot } = answer?.goal ?? {};
    const cut = settling ? X(Number(settling.re)) : 0;
    if (cut > 40 && cut < 464) line(cut, 16, cut, 336);
    if (overshoot?.slope) for (const side of [-1, 1]) {
      const slope = side * Number(overshoot.slope), far = Math.min(X(0) - 40, (side < 0 ? 336 - Y(0) : Y(0) - 16) / Math.abs(slope));
      if (far > 0) line(X(0), Y(0), X(0) - far, Y(0) - slope * far);
    }
    for (const m of answer?.marks ?? []) {
      const [x, y] = [X(Number(m.re)), Y(Number(m.im))];
      if (x > 38 && x < 466 && y > 14 && y < 338) parts.push(sv("path", { class: `mark ${m.kind}`, d: MARKS[m.kind](x, y) }, sv("title", {}, markName(m.kind))));
    }
    for (const group of view.sets) {
      const list = sets[group.key] ?? [], count = list.length;
      list.forEach((p, k) => p.raw || parts.push(handle(group, list, p, k, count)));
    }
    if (Object.values(sets).flat().some((p) => p.raw)) parts.push(sv("text", { x: 46, y: 330 }, w("in_fields")));
    el.poles.append(...parts);
    drawMarks();
    if (focus) refocus(focus);
  }

  const CROSS = (x, y, r) => `M${x - r} ${y - r}l${2 * r} ${2 * r}m0 ${-2 * r}l${-2 * r} ${2 * r}`;
  const MARKS = { plant: (x, y) => CROSS(x, y, 3.5), F: PLUS, loop: (x, y) => `M${x} ${y - 5}l5 5-5 5-5-5z`, control_pole: (x, y) => CROSS(x, y, 5), observer_pole: (x, y) => `M${x - 5} ${y}a5 5 0 1 1 0 .01` };
  const markName = (kind) => language[`pole_of_${kind}`] ?? w(kind);

  /** Say what the signs in the plane are. */
  function drawMarks() {
    const kinds = [...new Set((answer?.marks ?? []).map((m) => m.kind))];
    if (el.marks.dataset.of === `${view.sets.map((g) => g.mark)}${kinds}${root.lang}`) return;
    el.hint.hidden = !view.sets.length;
    el.required.hidden = !view.sets.length && !view.given.length;
    el.marks.dataset.of = `${view.sets.map((g) => g.mark)}${kinds}${root.lang}`;
    const sign = (mark, of, words) => h("span", {}, sv("svg", { viewBox: "0 0 16 16", "aria-hidden": "true", class: of }, mark), words);
    const ring = sv("circle", { class: "glyph", cx: 8, cy: 8, r: 5 }), cross = sv("path", { class: "glyph", d: CROSS(8, 8, 5) });
    el.marks.replaceChildren(...view.sets.map((g) => sign(g.mark === "cross" ? cross : ring, g.mark, w(g.label))), ...kinds.map((k) => sign(sv("path", { class: `mark ${k}`, d: MARKS[k](8, 8) }), "", markName(k))));
  }

  /** What stands still while poles are moved: the stable part, and the lines with their numbers. */
  function ground() {
    const [x0, x1, y0, y1] = [(40 - frame.x) / frame.scale, (464 - frame.x) / frame.scale, (frame.y - 336) / frame.scale, (frame.y - 16) / frame.scale];
    const line = (name, a, b, c, d) => sv("line", { class: name, x1: a, y1: b, x2: c, y2: d });
    const label = (x, y, words, anchor) => sv("text", { x, y, "text-anchor": anchor }, pretty(words));
    const parts = [sv("rect", { class: "ground", x: 40, y: 16, width: 424, height: 320 })];
    if (view.discrete) parts.push(sv("circle", { class: "stable", cx: X(0), cy: Y(0), r: frame.scale }));
    else parts.push(sv("rect", { class: "stable", x: 40, y: 16, width: Math.max(0, Math.min(464, X(0)) - 40), height: 320 }));
    for (const x of ticks(x0, x1, 8)) parts.push(line("rule", X(x), 16, X(x), 336), label(X(x), 350, String(x), "middle"));
    for (const y of ticks(y0, y1, 6)) parts.push(line("rule", 40, Y(y), 464, Y(y)), label(34, Y(y) + 4, `${y || 0}`, "end"));
    parts.push(line("axis", 40, Y(0), 464, Y(0)));
    if (X(0) > 40 && X(0) < 464) parts.push(line("axis", X(0), 16, X(0), 336));
    parts.push(label(464, Y(0) - 6, "Re", "end"), label(Math.min(456, Math.max(46, X(0) + 6)), 28, "Im", "start"));
    return parts;
  }

  /** Give the focus back to a handle that was drawn again; where it stood when it came there stays known. */
  function refocus(name) {
    quiet = true;
    el.poles.querySelector(`[data-handle="${name}"]`)?.focus({ preventScroll: true });
    quiet = false;
  }

  function handle(group, list, p, k, count) {
    const spoken = pretty(p.pair && p.im[0] ? w("pair", { real: text(p.re), imaginary: text(p.im) }) : text(p.re));
    const same = list.slice(0, k).filter((q) => !q.raw && !q.pair && !p.pair && text(q.re) === text(p.re)).length;
    const places = p.pair ? [[X(value(p.re)), Y(value(p.im))], [X(value(p.re)), Y(-value(p.im))]] : [[X(value(p.re)), Y(0)]];
    const nested = p.pair && !p.im[0];
    const glyph = ([x, y], index) => {
      const r = 6.5 + 4 * (same + (nested ? index : 0));
      return [sv("circle", { class: "hit", cx: x, cy: y, r: 18 }), sv("circle", { class: "halo", cx: x, cy: y, r: 12 }), group.mark === "cross" ? sv("path", { class: "glyph", d: CROSS(x, y, r) }) : sv("circle", { class: "glyph", cx: x, cy: y, r })];
    };
    const said = isOld("answer") ? null : answer?.readouts?.find((r) => r.handle === `${group.key}.${k}`);
    const isHeld = held && held.p === p;
    const mine = sv("g", {
      class: `handle ${group.mark}${isHeld ? " held" : ""}`, tabindex: 0, role: "slider", "data-handle": `${group.key}.${k}`,
      "aria-label": w("one_of", { pole: w(group.label), number: k + 1, count }), "aria-roledescription": w("pole"), "aria-valuemin": -100, "aria-valuemax": 100, "aria-valuenow": value(p.re), "aria-valuetext": spoken,
      ontouchstart: stay, onpointerdown: (e) => grab(e, group, p), onkeydown: (e) => key(e, group, p, k), onfocus: () => { if (!quiet) { before = JSON.stringify(sets); drawPlane(); } },
    }, places.map(glyph));
    const [x, y] = places[0], right = x < 250;
    const lines = [pretty(p.pair && p.im[0] ? `${text(p.re)} ± ${imaginary(p.im, " ")}` : text(p.re))];
    if (said?.damping && p.pair) lines.push(`ζ = ${pretty(said.damping)}, ${said.exact}`);
    if (said?.overshoot) lines.push(w("mode_overshoots", { percent: pretty(said.overshoot) }));
    if (said?.settles) lines.push(w("mode_settles", { time: pretty(said.settles) }));
    if (said?.modulus) lines.push(`|z| = ${pretty(said.modulus)}`);
    const below = y < 90, up = below ? 0 : lines.length - 1;
    mine.append(...lines.map((words, n) => sv("text", { class: n ? "readout" : "readout first", x: x + (right ? 16 : -16), y: below ? y + 26 : y - 12, dy: `${1.25 * (n - up)}em`, "text-anchor": right ? "start" : "end" }, words)));
    return mine;
  }

  const step = () => SNAPS[s.snap];
  const snapped = (x) => ratio(Math.round((x * GRID) / step()) * step(), GRID);

  /** Move a handle to a place of the plane, and keep the number of poles and their pairs. */
  function place(group, p, re, im) {
    const list = sets[group.key];
    if (!p.pair && Math.abs(im) >= 1.5 * (step() / GRID)) {
      const others = list.filter((q) => q !== p && !q.raw && !q.pair);
      if (others.length) {
        const nearest = others.reduce((a, b) => (Math.abs(value(a.re) - re) <= Math.abs(value(b.re) - re) ? a : b));
        list.splice(list.indexOf(nearest), 1);
        p.pair = true;
      }
    }
    p.re = snapped(re);
    p.im = p.pair ? snapped(Math.abs(im)) : [0, 1];
  }

  function where(event, svg) {
    const there = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    return [there.x, there.y];
  }

  /** Follow a pointer over a picture until it is let go; Escape, or what takes the pointer away, puts back. */
  function pursue(event, svg, follow, ended) {
    event.preventDefault();
    svg.setPointerCapture(event.pointerId);
    const heard = [[svg, "pointermove", follow], [svg, "pointerup", () => end(false)], [svg, "pointercancel", () => end(true)], [document, "keydown", (e) => { if (e.key === "Escape") { e.stopPropagation(); end(true); } }]];
    release = () => heard.forEach(([where, what, hear]) => where.removeEventListener(what, hear, true));
    const end = (back) => { drop(); ended(back); };
    for (const [where, what, hear] of heard) where.addEventListener(what, hear, true);
  }

  /** Let a finger move what it touches, not the page: `touch-action` is ignored inside of a picture. */
  const stay = (event) => event.preventDefault();

  function grab(event, group, p) {
    if (event.button) return;
    before = JSON.stringify(sets);
    held = { p };
    pursue(event, el.poles, (e) => {
      const [x, y] = where(e, el.poles);
      place(group, p, (Math.max(40, Math.min(464, x)) - frame.x) / frame.scale, (frame.y - Math.max(16, Math.min(336, y))) / frame.scale);
      moved(false);
    }, (back) => {
      if (back) sets = JSON.parse(before);
      const k = sets[group.key].indexOf(p);
      sets[group.key] = settled(sets[group.key]);
      isLetGo = true;
      moved(true);
      refocus(`${group.key}.${Math.max(0, k)}`);
    });
    drawPlane();
  }

  function key(event, group, p, k) {
    const far = (event.shiftKey ? 10 : 1) * step(), by = ratio(far, GRID), back = ratio(-far, GRID);
    const list = sets[group.key];
    switch (event.key) {
      case "ArrowLeft": p.re = plus(p.re, back); break;
      case "ArrowRight": p.re = plus(p.re, by); break;
      case "ArrowUp": if (p.pair) p.im = plus(p.im, by); else place(group, p, value(p.re), Math.max(2 * step(), far) / GRID); break;
      case "ArrowDown": if (!p.pair) return; p.im = plus(p.im, back); if (p.im[0] < 0) p.im = [0, 1]; break;
      case "Enter": find(group.key, "set")?.focus(); event.preventDefault(); return;
      case "Escape": if (before) sets = JSON.parse(before); moved(true); event.preventDefault(); return;
      default: return;
    }
    event.preventDefault();
    sets[group.key] = settled(list);
    moved(true);
    if (outside(p)) { fit(); drawPlane(); }
    refocus(`${group.key}.${k}`);
  }
  const outside = (p) => X(value(p.re)) < 48 || X(value(p.re)) > 456 || Y(value(p.im)) < 24;

  // -- the region --

  function buildPoint() {
    const region = view.region, svg = el.map.querySelector("svg");
    const fields = region.parameters.map((name) => field(`at.${name}`, name, s.at[name], (t) => { s.at[name] = t; settle(); drawPointHandle(); }));
    const name = region.parameters[0], [low, high] = (region.values ?? ["0", "1"]).map(numberOf);
    const scrubbed = () => {
      held = "scrub";
      s.at[name] = onGrid(low + (Number(scrub.value) / 400) * (high - low), high - low);
      write(fields[0].querySelector("input"), s.at[name]);
      commit(false);
      ask();
    };
    const scrub = region.values ? h("input", { type: "range", class: "scrub", "aria-label": name, min: 0, max: 400, step: 1, value: Math.round(((numberOf(s.at[name]) - low) / (high - low)) * 400) || 0, oninput: scrubbed, onchange: () => { held = null; settle(); } }) : null;
    el.pointVerdict = h("p", { class: "verdict" });
    el.pointMath = h("div", { class: "symobs" });
    el.point.replaceChildren(h("div", { class: "fields" }, fields), scrub ?? "", el.pointVerdict, el.pointMath);
    if (!svg || region.kind !== "plane") return;
    el.dot = sv("g", { class: "handle pick", tabindex: 0, role: "slider", "aria-roledescription": w("point"), "aria-label": w("point_of", { names: region.parameters.join(", ") }), "aria-valuenow": 0, onkeydown: (e) => {
      const moves = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowDown: [1, -1], ArrowUp: [1, 1] }[e.key];
      if (!moves) return;
      e.preventDefault();
      const name = region.parameters[moves[0]];
      s.at[name] = text(plus(rational(s.at[name]) ?? [0, 1], ratio(moves[1] * step() * (e.shiftKey ? 10 : 1), GRID)));
      drawPointHandle();
      settle();
    }, ontouchstart: stay, onpointerdown: grabPoint }, sv("circle", { class: "hit", r: 12 }), sv("circle", { class: "halo", r: 6 }), sv("circle", { class: "glyph", r: 3.4 }));
    svg.append(el.dot);
    svg.addEventListener("pointerdown", (e) => { if (!el.dot.contains(e.target)) grabPoint(e); });
    drawPointHandle();
  }

  const onGrid = (x, width) => { let grid = GRID; while (grid * width < 40) grid *= 10; return text(ratio(Math.round(x * grid), grid)); };
  function placeOf(k) {
    const [left, top, width, height] = view.region.frame, [low, high] = view.region.window[k].map(numberOf);
    const part = (numberOf(s.at[view.region.parameters[k]]) - low) / (high - low);
    return k ? top + height * (1 - part) : left + width * part;
  }
  function drawPointHandle() {
    const region = view.region;
    if (region.kind === "plane" && el.dot) {
      const inside = region.parameters.every((name) => rational(s.at[name]));
      el.dot.toggleAttribute("hidden", !inside);
      if (inside) el.dot.setAttribute("transform", `translate(${placeOf(0)} ${placeOf(1)})`);
      el.dot.setAttribute("aria-valuetext", region.parameters.map((n) => `${n} = ${pretty(s.at[n])}`).join(", "));
    }
    region.parameters.forEach((name) => { const input = find(`at.${name}`); write(input, s.at[name]); });
  }

  function grabPoint(event) {
    if (event.button) return;
    const svg = el.map.querySelector("svg"), region = view.region, [left, top, width, height] = region.frame, before = { ...s.at };
    held = "point";
    const follow = (e) => {
      const [x, y] = where(e, svg), part = [(x - left) / width, 1 - (y - top) / height];
      region.parameters.forEach((name, k) => {
        const [low, high] = region.window[k].map(numberOf);
        s.at[name] = onGrid(low + Math.max(0, Math.min(1, part[k])) * (high - low), high - low);
      });
      drawPointHandle();
      commit(false);
      ask();
    };
    pursue(event, svg, follow, (back) => {
      if (back) s.at = before;
      drawPointHandle();
      settle();
      el.dot.focus({ preventScroll: true });
    });
    follow(event);
  }

  function drawPoint(got, asked) {
    if (got.status !== "done") { drawAnswer(got); return; }
    clearWrong();
    point = got;
    answered.point = asked;
    fade();
    const there = { ...view.region.drawn_for, ...s.at };
    el.pointVerdict.textContent = `${Object.keys(there).map((n) => `${n} = ${pretty(there[n])}`).join(", ")}: ${w(`point_${got.verdict}`)}`;
    el.pointVerdict.dataset.verdict = got.verdict;
    el.pointMath.innerHTML = [...(got.cards ?? []), ...(got.boundary ?? [])].map((c) => `<div class="display">${c.mathml}</div>`).join("");
    const middle = (p) => (Number(p[0]) + Number(p[1])) / 2, digits = (p) => pretty(middle(p).toFixed(3));
    const roots = got.roots.map((r) => `${digits(r.re)}${Number(r.im[1]) > 0 && Number(r.im[0]) > 0 ? ` + ${digits(r.im)} i` : Number(r.im[1]) < 0 ? ` − ${digits(r.im).slice(1)} i` : ""}${r.multiplicity > 1 ? ` (${r.multiplicity}×)` : ""}`);
    el.pointMath.append(h("p", { class: "roots" }, roots.length ? w("roots", { roots: roots.join(language.decimal_mark === "," ? ";  " : ",  ") }) : ""));
    if (view.region.kind === "locus") {
      const svg = el.map.querySelector("svg"), [left, top, width, height] = view.region.frame, [[a, b], [c, d]] = view.region.window.map((w) => w.map(numberOf));
      svg.querySelectorAll(".root").forEach((e) => e.remove());
      for (const r of got.roots) svg.append(sv("circle", { class: "root", cx: left + (width * (middle(r.re) - a)) / (b - a), cy: top + height * (1 - (middle(r.im) - c) / (d - c)), r: 2.6 }));
    }
  }

  // -- answers --

  /** Take away what was wrong; what a field of the page itself refused stays until the field is changed. */
  function clearWrong() {
    if ([...unentered.values()].includes("refused")) return;
    root.querySelectorAll(".wrong").forEach((e) => e.replaceChildren());
    root.querySelectorAll("[aria-invalid]").forEach((e) => e.removeAttribute("aria-invalid"));
    say("");
  }

  /** Declare a letter; a slider gives it a value, too. */
  function declare(name, as) {
    s.symbols[name] = as === "positive" ? as : "real";
    if (as === "slider") s.at[name] = "1";
    problemChanged();
  }

  function showErrors(errors) {
    const left = [];
    for (const { where, message, repair, lang, undeclared } of errors) {
      const words = `${message}${repair ? `: ${repair}` : ""}`, base = where.replace(/\[.*$/, "");
      const exact = where.replace(/\[(\d+)\]\[(\d+)\]$/, (_, i, j) => `[${Number(i) + 1},${Number(j) + 1}]`);
      const input = find(exact) ?? find(base.replace("specification.", ""), "set") ?? find(base);
      const below = find(base, "of"), field = input ?? (below ? null : find(base.replace("plant.", "text.")));
      field?.setAttribute("aria-invalid", "true");
      field?.closest("details")?.setAttribute("open", "");
      const spot = field?.closest(".field")?.querySelector(".wrong") ?? below;
      if (spot) spot.append(h("span", { lang }, words), ...(undeclared ? ["real", "positive", "slider"].map((as) => h("button", { onclick: () => declare(undeclared, as) }, w(`as_${as}`))) : [])); else left.push(`${where ? `${where}: ` : ""}${words}`);
    }
    if (left.length) say(left.slice(0, 4).join(" · "));
  }

  function drawAnswer(got, asked) {
    if (got.id) drawn = got.id;
    clearWrong();
    if (got.status === "bad") { showErrors(got.errors); return; }
    if (got.status === "bug" || (got.status === "undecided" && !got.cards)) { say(got.status === "bug" ? got.message : w("undecided", { reason: got.message }), () => ask()); return; }
    answer = got;
    answered.answer = asked;
    fade();
    show(got);
  }

  /** Show an answer. */
  function show(got) {
    const claims = got.verdict === "no" ? [] : [w("checked"), w(got.claims === 1 ? "claim" : "claims", { count: got.claims })];
    const told = [pretty(got.says), ...claims].join(" · ");
    if (el.verdict.textContent !== told) el.verdict.textContent = told;
    el.verdict.dataset.verdict = got.unstable.length ? "unstable" : got.verdict;
    if (el.notes.textContent !== (got.note ?? "")) el.notes.textContent = got.note ?? "";
    drawCards(got);
    const others = (names, words) => names.map((name) => h("button", { class: "quiet", "data-where": `give.${name}`, onclick: () => give(name) }, w(words, { name })));
    if (view) keepingFocus(() => el.gains.replaceChildren(...others(view.sets.map((g) => g.gain).filter((name) => got.result[name]), "move_gain"), ...others(view.given, "move_poles")));
    drawGoals();
    if (!el.cases.hidden) drawCases(got);
    if (!el.responses.hidden) {
      drawCurves(page, el.curves, el.legend, got.courses, got.courses);
      drawCurves(page, el.effort, el.efforts, got.courses?.effort, got.courses);
      el.starts.hidden = isStep();
    }
    if (!el.loop.hidden) drawLoop(page, got.loop);
    drawPlane(isLetGo);  // the poles of F are known now
    isLetGo = false;
  }

  function drawCards(got) {
    const names = got.cards.map((c) => c.name);
    if ([...el.list.children].map((c) => c.dataset.name).join() !== [...names, "conditions"].join()) {
      el.list.replaceChildren(...got.cards.map((card) => h("article", { class: "card symobs", "data-name": card.name }, h("div", { class: "display" }), h("button", { class: "quiet tex", title: w("copy_latex"), "aria-label": w("copy_latex_of", card), onclick: (e) => copy(e.target.parentNode.firstChild.dataset.latex, e.target, "TeX") }, "TeX"), h("button", { class: "quiet tex", title: w("show_line"), "aria-label": w("show_line_of", card), onclick: (e) => trace(e.target.parentNode) }, "↓"))), h("article", { class: "conditions symobs", "data-name": "conditions" }));
    }
    got.cards.forEach((card, k) => {
      const box = el.list.children[k].firstChild;
      if (box.shown !== card.mathml) { box.innerHTML = card.mathml; box.shown = card.mathml; }
      box.dataset.latex = card.latex ?? "";
    });
    const last = el.list.lastChild;
    last.innerHTML = got.conditions.length ? `<p>${w("provided")}</p>${got.conditions.map((c) => `<div class="display">${c.mathml}</div>`).join("")}` : "";
  }

  /** Keep a design beside those that follow, with the answers as they were checked. */
  function pin() {
    if (!answer || isOld("answer")) return;
    const gains = answer.cards.filter((card) => view.gains.includes(card.name)).map((card) => card.mathml).join("");
    const effort = (answer.courses?.effort?.lines ?? []).map((line) => line.peak ?? "").join("; ");
    pinned = [...pinned.filter((each) => each.link !== encoded(s)), { link: encoded(s), task: s.task, poles: view.sets.map((group) => s.spec[group.key]).join("; "), gains, effort, says: answer.says }].slice(-MOST_PINNED);
    drawPins();
  }

  function drawPins() {
    const row = (kind, ...inside) => h("tr", {}, inside.map((cell) => h(kind, {}, cell)));
    const math = (source) => { const cell = h("div", { class: "symobs" }); cell.innerHTML = source; return cell; };
    const rows = pinned.map((each) => row("td", h("button", { onclick: () => shift(each.link) }, pretty(each.poles) || taskName(each.task)), math(each.gains), pretty(each.effort), pretty(each.says), h("button", { class: "quiet", "aria-label": w("unpin", { poles: pretty(each.poles) }), onclick: () => { pinned = pinned.filter((other) => other !== each); drawPins(); el.pin.focus(); } }, "×")));
    el.pins.replaceChildren(...(rows.length ? [h("table", {}, h("caption", {}, w("pinned")), h("thead", {}, row("th", w("plane"), w("gains"), w("effort_peak"), w("cards"), h("span", { class: "hidden" }, w("unpin", { poles: "" })))), h("tbody", {}, rows))] : []));
  }

  function drawCases(got) {
    if (!got.cases) return;
    const general = h("button", { class: Object.keys(free()).length ? "" : "chosen", onclick: () => { s.at = {}; problemChanged(); } }, w("in_general"));
    const made = got.cases.map((c) => {
      const usable = Object.keys(c.at).length > 0;
      const b = h("button", { disabled: !usable, "data-case": JSON.stringify(c.at), onclick: () => { s.at = { ...c.at }; problemChanged(); } });
      const said = usable ? Object.entries(c.at).map((pair) => pair.join(" = ")) : c.when.map((each) => each.text);
      b.innerHTML = `<span aria-hidden="true">${(c.mathml.length ? c.mathml : c.when.map((w) => w.mathml)).join(" ")}</span>`;
      b.append(h("span", { class: "hidden" }, said.join(", ")));
      return h("div", { class: "case-row" }, b, h("span", { class: "pale" }, c.rank !== undefined ? w("rank", c) : w(`case_${c.verdict}`)));
    });
    el.casesBody.replaceChildren(...(made.length ? [general, ...made] : [h("p", { class: "pale" }, w(Object.keys(s.symbols).length ? "no_values" : "no_letters"))]));
    el.casesBody.querySelectorAll("[data-case]").forEach((b) => b.classList.toggle("chosen", b.dataset.case === JSON.stringify(free())));
  }

  // -- begin --

  const isEmpty = () => !Object.keys(s.plant).length && s.spec.polynomial === undefined;
  const begin = () => {
    build();
    if (view?.panels.includes("region") && signature() === viewed) {
      drawMap();
      if (point && !isOld("point")) drawPoint(point, answered.point);
    }
    if (isEmpty()) turn(s.task); else ask();
  };
  root.addEventListener("keydown", (e) => {
    if (!(e.ctrlKey || e.metaKey) || e.key.toLowerCase() !== "z" || /** @type {HTMLElement} */ (e.target).closest("input")) return;
    e.preventDefault();
    walk(e.shiftKey ? 1 : -1);
  });
  const resized = new ResizeObserver(() => reachable());
  resized.observe(root);
  begin();
  return {
    destroy() { gone = true; resized.disconnect(); aborted.abort(); root.remove(); },
    state: () => encoded(s),
    /** Take over a state that is written already: of the history of the browser, or of another view. */
    set(link) {
      turning = 0;
      s = begun(link);
      frame = null;
      const now = encoded(s), near = [reached, reached - 1, reached + 1].find((k) => steps[k] === now);
      if (near === undefined) steps.splice(reached + 1, Infinity, now);
      reached = near ?? reached + 1;
      begin();
      drawSteps();
    },
  };
}

/** Show a page whose state is that of its address: a drag is one step of its history, which Back undoes. */
export function atAddress(transport) {
  let moving = false, timer = 0;
  const main = /** @type {HTMLElement} */ (document.querySelector("main"));
  const live = mount(main, transport, {
    state: location.hash,
    link: (state) => `${main.dataset.share || `${location.origin}${location.pathname}`}#${state}`,
    changed(state, final) {
      const write = () => { history[moving ? "replaceState" : "pushState"](null, "", `#${state}`); moving = !final; };
      clearTimeout(timer);
      if (final || !moving) write(); else timer = setTimeout(write, REST);  // it takes longer than a picture
    },
  });
  addEventListener("popstate", () => live.set(location.hash));
}
