// @ts-check
// The state of a page as its link has it.

export const SNAPS = { "1/20": 1, "1/10": 2, "1/4": 5, "1/2": 10, 1: 20 };
export const PLANT = ["A", "B", "C", "D", "transfer_function", "dt", "delay", "pade"];
export const DETAILS = ["full", "outline", "answer"];
export const PANELS = ["plane", "responses", "loop", "cards", "cases", "region", "page"];
const SHORT = { control: "control_poles", observer: "observer_poles", order: "observer" };
const OWN = ["v", "task", "symbols", "convention", "language", "at", "snap", "closed", "detail", "x0", "xh0", "step", "goal"];

/** @param {string} link */
export function decoded(link) {
  const given = Object.fromEntries(new URLSearchParams(link.replace(/^#/, "").replace(/\+/g, "%2B")));
  const state = { task: given.task ?? "", plant: {}, spec: {}, symbols: {}, at: {}, convention: given.convention ?? "", language: given.language ?? "" };
  const listed = (source) => Object.fromEntries((source ?? "").split(",").filter(Boolean).map((e) => e.split(/:(.*)/s)).map(([name, entry = ""]) => [name, entry.replace(/%2C/g, ",")]));
  Object.assign(state, { symbols: listed(given.symbols), at: listed(given.at), goal: listed(given.goal) });
  Object.assign(state, { snap: given.snap in SNAPS ? given.snap : "1/2", closed: (given.closed ?? "loop").split(",").filter((name) => PANELS.includes(name)) });
  Object.assign(state, { detail: DETAILS.includes(given.detail) ? given.detail : "full", x0: given.x0 ?? "", xh0: given.xh0 ?? "", step: given.step ?? "" });
  for (const [key, entry] of Object.entries(given)) {
    if (PLANT.includes(key)) state.plant[key] = entry;
    else if (!OWN.includes(key) && key !== "token") state.spec[SHORT[key] ?? key] = entry;
  }
  return state;
}

export function encoded(state) {
  const long = Object.fromEntries(Object.entries(SHORT).map(([a, b]) => [b, a]));
  const paired = (table) => Object.entries(table).map(([name, entry]) => `${name}:${entry.replace(/,/g, "%2C")}`).join(",");
  const spec = Object.fromEntries(Object.entries(state.spec).map(([key, entry]) => [long[key] ?? key, entry]));
  const all = { v: 1, task: state.task, ...state.plant, ...spec, symbols: paired(state.symbols), at: paired(state.at) };
  Object.assign(all, { convention: state.convention, language: state.language, snap: state.snap === "1/2" ? "" : state.snap });
  Object.assign(all, { closed: String(state.closed) === "loop" ? "" : state.closed.join(",") || "none", detail: state.detail === "full" ? "" : state.detail, x0: state.x0, xh0: state.xh0, step: state.step, goal: paired(state.goal) });
  const plain = (t) => encodeURIComponent(t).replace(/%(2C|3B|3A|2F|5B|5D|5E)/g, decodeURIComponent);
  return Object.entries(all).filter(([, entry]) => entry !== "" && entry !== undefined).map(([key, entry]) => `${key}=${plain(String(entry))}`).join("&");
}
