// @ts-check
// Elements of HTML and SVG, round numbers of an axis, paths, and the names of signals.

const SVG = "http://www.w3.org/2000/svg";

export function h(tag, attributes = {}, ...inside) {
  const made = tag.startsWith("svg:") ? document.createElementNS(SVG, tag.slice(4)) : document.createElement(tag);
  for (const [name, entry] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), entry);
    else if (entry !== undefined && entry !== false) made.setAttribute(name, entry === true ? "" : entry);
  }
  made.append(...inside.flat(Infinity).filter((part) => part !== null && part !== undefined));
  return made;
}

export const sv = (tag, ...more) => h(`svg:${tag}`, ...more);

/** Round numbers of an interval, about so many. */
export function ticks(low, high, count) {
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough) ?? rough;
  const first = Math.ceil(low / step - 1e-9), many = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: many }, (_, k) => Number(((first + k) * step).toPrecision(12)));
}

export const SUB = (n) => String(n).replace(/\d/g, (d) => "₀₁₂₃₄₅₆₇₈₉"[Number(d)]);
const SIGNALS = { x_hat: "x̂", e_2: "e" };
export const nameOf = (line) => `${SIGNALS[line.signal] ?? line.signal}${line.component ? SUB(line.component) : ""}`;

/** A path through points, with gaps where one is not known. */
export const pathOf = (points, place) => points.reduce((path, p, k) => (p === null ? path : `${path}${k && points[k - 1] !== null ? "L" : "M"}${place(p, k)}`), "");

/** The mark of a pole of the controller. */
export const PLUS = (x, y) => `M${x - 4} ${y}h8M${x} ${y - 4}v8`;
