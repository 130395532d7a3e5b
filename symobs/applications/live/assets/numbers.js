// @ts-check
// Exact numbers, poles and matrices as they are typed: [numerator, denominator] on a grid, texts, fields.

const gcd = (a, b) => (b ? gcd(b, a % b) : Math.abs(a));
export const ratio = (n, d = 1) => { const g = gcd(n, d) || 1; return d < 0 ? [-n / g, -d / g] : [n / g, d / g]; };
export const plus = (a, b) => ratio(a[0] * b[1] + b[0] * a[1], a[1] * b[1]);
export const value = (a) => a[0] / a[1];
export const text = (a) => (a[1] === 1 ? `${a[0]}` : `${a[0]}/${a[1]}`);

/** Read a rational number; null for anything else. @param {string} source */
export function rational(source) {
  const found = /^([+-]?)\s*(\d+)(?:\/(\d+)|\.(\d+))?$/.exec(source.trim());
  if (!found || source.length > 15) return null;
  const [, sign, whole, below, digits] = found;
  const number = digits ? ratio(Number(whole + digits), 10 ** digits.length) : ratio(Number(whole), Number(below ?? 1));
  return number[1] ? (sign === "-" ? ratio(-number[0], number[1]) : number) : null;
}

/** Split at commas outside of parentheses. @param {string} source */
export function parts(source) {
  const found = [""];
  let depth = 0;
  for (const c of source.replace(/^\s*\[|\]\s*$/g, "")) {
    depth += c === "(" ? 1 : c === ")" ? -1 : 0;
    if ((c === "," || c === ";") && depth === 0) found.push("");
    else found[found.length - 1] += c;
  }
  return found.map((part) => part.trim()).filter(Boolean);
}

/** Read poles: handles {re, im}, a pair once, and texts that no handle can hold. @param {string} source */
export function handles(source) {
  const waiting = parts(source).map((entry) => {
    const plain = entry.replace(/\s+/g, "").replace(/−/g, "-").replace(/(^|[+-])[ij]\*?([\d./]+)$/, "$1$2i");
    const real = rational(plain);
    if (real) return { re: real, im: [0, 1] };
    const found = /^([+-]?[\d./]+(?=[+-]))?([+-]?[\d./]*)\*?[ij]$/.exec(plain);
    if (!found) return { raw: entry };
    const re = rational(found[1] ?? "0"), im = rational(/\d/.test(found[2]) ? found[2] : `${found[2]}1`);
    return re && im ? { re, im } : { raw: entry };
  });
  const kept = [];
  while (waiting.length) {
    const one = waiting.shift();
    if (one.raw || one.im[0] === 0) { kept.push(one); continue; }
    const other = waiting.findIndex((p) => !p.raw && text(p.re) === text(one.re) && p.im[0] === -one.im[0] && p.im[1] === one.im[1]);
    if (other < 0) { kept.push({ raw: written(one) }); continue; }
    waiting.splice(other, 1);
    kept.push({ re: one.re, im: ratio(Math.abs(one.im[0]), one.im[1]), pair: true });
  }
  return kept;
}

export const imaginary = (im, space = "") => `${text(im)}${space}i`.replace(/^(-?)1 ?i$/, "$1i");

export function written(p) {
  if (p.raw) return p.raw;
  if (!p.pair) return p.im[0] ? `${p.re[0] ? text(p.re) : ""}${p.im[0] > 0 && p.re[0] ? "+" : ""}${imaginary(p.im)}` : text(p.re);
  if (!p.im[0]) return `${text(p.re)}, ${text(p.re)}`;
  const re = p.re[0] ? text(p.re) : "";
  return `${re}${re ? "+" : ""}${imaginary(p.im)}, ${re}-${imaginary(p.im)}`;
}

export const poles = (list) => list.map(written).join(", ");
export const settled = (list) => list.flatMap((p) => (p.pair && !p.im[0] ? [{ re: p.re, im: [0, 1] }, { re: p.re, im: [0, 1] }] : [p]));

// -- matrices as grids of fields --

/** Split a matrix into cells; null where rows differ. @param {string} source */
export function cells(source) {
  const inside = String(source).trim().replace(/^\[|\]$/g, "");
  const rows = inside.split(/[;\n]/).map((row) => {
    const found = [""];
    let depth = 0;
    [...row.trim()].forEach((c, k, all) => {
      depth += c === "(" ? 1 : c === ")" ? -1 : 0;
      const before = all.slice(0, k).join("").trimEnd().slice(-1), after = all.slice(k).join("").trimStart();
      const joins = /[-+*/^]/.test(before) || /^[*/^]/.test(after) || /^[-+]\s/.test(after);
      if (depth === 0 && (c === "," || (/\s/.test(c) && !joins))) { if (found[found.length - 1]) found.push(""); }
      else if (!/\s/.test(c) || depth) found[found.length - 1] += c;
    });
    return found.filter(Boolean);
  });
  return rows.every((row) => row.length === rows[0].length && row.length) ? rows : null;
}
export const matrix = (rows) => `[${rows.map((row) => row.map((c) => (/\s/.test(c.replace(/\(.*\)/g, "")) ? `(${c})` : c || "0")).join(" ")).join("; ")}]`;

/** The number that a text is. @param {string} t */
export const numberOf = (t) => (rational(t) ? value(rational(t)) : Number(t));
