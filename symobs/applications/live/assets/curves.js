// @ts-check
// Curves over time and over the frequency, and the loop in its plane; `page` has the elements, the words and their marks.

import { numberOf } from "./numbers.js";
import { PLUS, h, nameOf, pathOf, sv, ticks } from "./elements.js";

/** Draw responses over time, of which `all` says up to when. */
export function drawCurves({ el, w, pretty }, svg, legend, got, all) {
  if (svg.classList.toggle("absent", !got)) { legend.replaceChildren(); return; }
  const [[t0, t1], [low, high]] = got.window.map((w) => w.map(numberOf));
  const px = (t) => 40 + ((t - t0) / (t1 - t0)) * 424, py = (v) => 268 - ((v - low) / (high - low || 1)) * 252;
  const made = [sv("rect", { class: "ground", x: 40, y: 16, width: 424, height: 252 })];
  for (const t of ticks(t0, t1, 7)) made.push(sv("line", { class: "rule", x1: px(t), y1: 16, x2: px(t), y2: 268 }), sv("text", { x: px(t), y: 284, "text-anchor": "middle" }, pretty(String(all.lg ? Number((10 ** t).toPrecision(2)) : t))));
  for (const v of got.rules ?? ticks(low, high, 6)) made.push(sv("line", { class: v === (got.axis ?? 0) ? "axis" : "rule", x1: 40, y1: py(v), x2: 464, y2: py(v) }), sv("text", { x: 34, y: py(v) + 4, "text-anchor": "end" }, pretty(String(v))));
  made.push(sv("text", { x: 464, y: 284, dy: "1.15em", "text-anchor": "end" }, all.lg ?? (all.discrete ? "k" : "t")));
  const told = [], named = [], ends = svg === el.curves && all.step ? all.ends : [];
  if (svg === el.curves && all.step) made.push(sv("line", { class: "goal", x1: 40, y1: py(1), x2: 464, y2: py(1) }), sv("text", { x: 458, y: py(1) - 5, "text-anchor": "end" }, "r = 1"));
  for (const [place, line] of got.lines.entries()) {
    const n = line.heights.length - 1, spot = (v, k) => `${px(t0 + ((t1 - t0) * k) / n).toFixed(1)} ${py(v / got.parts).toFixed(1)}`;
    const kind = `curve c${((line.component || 1) - 1) % 4}${line.dashed ? " dashed" : ""}`;
    made.push(sv("path", { class: kind, d: pathOf(line.heights, spot) }));
    if (all.discrete) line.heights.forEach((v, k) => { const [x, y] = spot(v, k).split(" "); made.push(sv("circle", { class: kind, cx: x, cy: y, r: 2.6 })); });
    const settles = [Number(line.overshoot) ? w("overshoots", { percent: pretty(line.overshoot) }) : "", line.settles ? w("settles", { time: pretty(line.settles) }) : "", line.signal === "u" && line.peak ? w("peak", { peak: pretty(line.peak) }) : ""].filter(Boolean).join(", ");
    if (line.peak) told.push(`${w("peaks", { signal: nameOf(line), peak: pretty(line.peak), last: pretty(ends[place] ?? line.last) })}${settles && `, ${settles}`}`);
    const said = [ends[place] ? w("ends", { end: pretty(ends[place]) }) : "", settles].filter(Boolean).join(", ");
    named.push(h("span", {}, sv("svg", { viewBox: "0 0 24 8", "aria-hidden": "true" }, sv("path", { class: kind, d: "M1 4h22" })), nameOf(line), h("small", {}, said)));
  }
  if (all.end) svg.setAttribute("aria-label", told.length ? w("up_to", { end: all.end, told: told.join("; ") }) : w(svg === el.effort ? "effort" : "responses"));
  svg.replaceChildren(...made);
  legend.replaceChildren(...named);
}

/** Draw a loop over the frequency, in its plane, and say how far it is from instability. */
export function drawLoop(page, got) {
  const { el, w, pretty } = page, clip = `${el.titles.id}-clip`;
  drawCurves(page, el.magnitude, el.magnitudes, got?.magnitude, { lg: "ω" });
  drawCurves(page, el.phase, el.phases, got && { ...got.phase, axis: -180 }, { lg: "ω" });
  if (got) for (const [name, place] of [["magnitude", "magnitudes"], ["phase", "phases"], ["locus", "loci"]]) el[place].textContent = w(name);
  el.margins.textContent = got ? pretty(got.says) : w("no_loop");
  el.locus.classList.toggle("absent", !got);
  if (!got) { el.loci.textContent = ""; return; }
  const scale = 126 / Number(got.reach), x = (re) => 252 + re * scale, y = (im) => 142 - im * scale;
  const line = (x1, y1, x2, y2) => sv("line", { class: "axis", x1, y1, x2, y2 });
  const curve = (sign, more) => sv("path", { class: `curve c0${more}`, "clip-path": `url(#${clip})`, d: pathOf(got.locus.map((p) => (p.includes(null) ? null : p)), (p) => `${x(p[0] / got.parts).toFixed(1)} ${y((sign * p[1]) / got.parts).toFixed(1)}`) });
  el.locus.replaceChildren(sv("clipPath", { id: clip }, sv("rect", { x: 40, y: 16, width: 424, height: 252 })), sv("rect", { class: "ground", x: 40, y: 16, width: 424, height: 252 }), line(40, y(0), 464, y(0)), line(x(0), 16, x(0), 268), sv("circle", { class: "mark", cx: x(0), cy: y(0), r: scale, "clip-path": `url(#${clip})` }), sv("path", { class: "mark F", d: PLUS(x(-1), y(0)) }), sv("text", { x: x(-1), y: y(0) + 18, "text-anchor": "middle" }, "−1"), curve(-1, " dashed"), curve(1, ""));
}
