// One run, picked on a chart, with the keyboard or from the lists: its results, its file and its commands.
const runs = data.runs;
const picked = { law: 0, initial: 0, a: 0 };
const agreementWords = { "-1": "undetermined", 0: "the laws disagree here", 1: "the laws agree here" };

/** Return rows [name, value] of the laws that a run is compared with: of the first law all others, else that one. */
const comparedRows = ({ law, initial, a }) => runs.laws.slice(1).flatMap((name, n) => (law === 0 || law === n + 1
  ? [[`${name} law compared with the ${runs.laws[0]} law`, agreementWords[runs.agrees[n][initial][a]]]] : []));

const commandsOf = ({ law, initial, a }) => {
  const path = `points/${runs.laws[law]}/${runs.initial[initial]}/a${runs.names[a]}.nc`;
  const parts = runs.simulate[law][initial];
  return {
    path,
    snakemake: ["snakemake -c1 --force", `${runs.results}/${path}`, runs.arguments].filter(Boolean).join(" "),
    simulate: `${parts.join(` --a ${runs.texts[a]} `)}${runs.names[a]}.nc`,
  };
};

/** Return rows [name, value] of the picked run; values are text or elements. */
function rowsOf({ law, initial, a }) {
  const at = (name) => runs[name][law][initial][a];
  const exponents = at("exponent_texts").map((text, n) => `λ${subscript(n + 1)} = ${text}`);
  return [
    ["Run", element("span", {}, `${runs.laws[law]} law, initial state ${runs.initial[initial]}, `, element("i", {}, "a"), `\u00a0=\u00a0${runs.texts[a]}`)],
    [element("span", {}, "⟨", element("i", {}, "J"), "⟩"), at("mean_distance_text")],
    ["Status", runs.statuses[at("status")].replaceAll("_", " ")],
    ["Kind of motion", at("kind_text")],
    ["Lyapunov exponents", exponents.length ? element("ul", { class: "values" }, ...exponents.map((text) => element("li", {}, text))) : "none computed"],
    ...comparedRows({ law, initial, a }),
    ["File", element("a", { href: commandsOf({ law, initial, a }).path, id: "run-file" }, commandsOf({ law, initial, a }).path)],
  ];
}

const subscript = (number) => String.fromCodePoint(...[...String(number)].map((digit) => 0x2080 + Number(digit)));

function pick(law, initial, a) {
  Object.assign(picked, { law, initial, a });
  byId("run-law").value = law;
  byId("run-initial").value = initial;
  byId("run-a").value = a;
  byId("run-previous").disabled = a === 0;
  byId("run-next").disabled = a === runs.a.length - 1;
  const list = element("dl", { class: "facts" }, ...rowsOf(picked).map(([name, value]) =>
    element("div", {}, element("dt", {}, name), element("dd", {}, value))));
  byId("run-detail").replaceChildren(list);
  const commands = commandsOf(picked);
  byId("run-snakemake").textContent = commands.snakemake;
  byId("run-simulate").textContent = commands.simulate;
  byId("copied").textContent = "";
  drawn.forEach((box) => { if ("law" in box.dataset) draw(box); });
  showBlocks();
}

/** Mark the picked run in a chart of the runs of its law. */
function markPicked(box, figure) {
  if (Number(box.dataset.law) !== picked.law) return;
  const y = runs.mean_distance[picked.law][picked.initial][picked.a];
  Object.assign(figure.data.at(-1), { x: [runs.a[picked.a]], y: [typeof y === "number" ? y : 0] });
}

const clamp = (value, size) => Math.min(Math.max(value, 0), size - 1);
const step = (initial, a) => pick(picked.law, clamp(picked.initial + initial, runs.initial.length), clamp(picked.a + a, runs.a.length));

/** Let a chart of runs be picked on, by pointer and by arrow keys. */
function connectRuns(box) {
  if (!("law" in box.dataset)) return;
  box.on("plotly_click", ({ points }) => {
    const run = points.find((point) => point.data.meta === "run");
    if (run) pick(Number(box.dataset.law), run.customdata[0], run.pointNumber);
  });
  const moves = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] };
  box.addEventListener("keydown", (event) => {
    const move = moves[event.key];
    if (!move || event.altKey || event.ctrlKey || event.metaKey || event.target !== box) return;
    event.preventDefault();
    picked.law = Number(box.dataset.law);
    step(...move);
  });
}

async function copyCommand(button) {
  const source = byId(button.dataset.copies);
  let copied = true;
  try {
    await navigator.clipboard.writeText(source.textContent);
  } catch {
    // Without a clipboard the text is selected, so that a key copies it.
    const range = document.createRange();
    range.selectNodeContents(source);
    const selection = window.getSelection();
    selection.removeAllRanges();
    selection.addRange(range);
    copied = document.execCommand("copy");
  }
  byId("copied").textContent = copied ? "Copied." : "Selected: copy it with the keyboard.";
}

function startRuns() {
  const fill = (id, names) => byId(id).replaceChildren(...names.map((name, n) => element("option", { value: n }, name)));
  fill("run-law", runs.laws);
  fill("run-initial", runs.initial);
  fill("run-a", runs.texts);
  for (const id of ["run-law", "run-initial", "run-a"])
    byId(id).addEventListener("change", () => pick(...["run-law", "run-initial", "run-a"].map((name) => Number(byId(name).value))));
  byId("run-previous").addEventListener("click", () => step(0, -1));
  byId("run-next").addEventListener("click", () => step(0, 1));
  document.querySelectorAll("[data-copies]").forEach((button) => button.addEventListener("click", () => copyCommand(button)));
  pick(...runs.first);
}
