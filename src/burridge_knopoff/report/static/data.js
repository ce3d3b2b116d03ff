// The numbers of the page, and how they are shown.
const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);

/** Return a number as text with a true minus sign; a dash where there is none. */
const shown = (value) => (value === null || value === undefined ? "–" : String(value).replaceAll("-", "−"));

/** Return a number with few digits, for labels under the pointer. */
const short = (value) => (value === null || value === undefined ? "–" : shown(Number(value.toPrecision(5))));

/** Return the number, or null where a chart cannot show it: infinities are text. */
const plain = (value) => (typeof value === "number" ? value : null);

/** Return an element with a class and children: text or elements. */
function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

/** Return the bytes of base64 text. */
function bytes(text) {
  const raw = atob(text);
  return Uint8Array.from(raw, (character) => character.charCodeAt(0));
}

/** Return the edges between ascending values: each value's cell is what lies nearest to it. */
function cells(values) {
  if (values.length === 1) return [values[0] - 0.5, values[0] + 0.5];
  const middle = values.slice(1).map((value, n) => 0.5 * (value + values[n]));
  const last = values.length - 1;
  return [2 * values[0] - middle[0], ...middle, 2 * values[last] - middle[last - 1]];
}

/** The edges between the values of a of the study; nothing is known beyond the first and the last one. */
const aEdges = ((a) => cells(a).map((edge) => (a.length === 1 ? edge : Math.min(Math.max(edge, a[0]), a.at(-1)))))(data.runs.a);

const branchOf = new Map(data.branches.map((branch) => [branch.number, branch]));
const kindOf = new Map(data.kinds.map((kind) => [kind.number, kind]));
