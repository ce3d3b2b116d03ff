// One run, picked on a chart, with the keyboard or from the lists: its results, its file and its commands.
const runs = data.runs;
const picked = { law: -1, initial: -1, a: -1, timer: 0 };
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
    ["Run", element("span", {}, `${runs.laws[law]} law, initial state ${runs.initial[initial]}`,
      ...(runs.has_a ? [", ", element("i", {}, "a"), `\u00a0=\u00a0${runs.texts[a]}`] : []))],
    ...(runs.has_end_blocks ? [[element("span", {}, "⟨", element("i", {}, "J"), "⟩"), at("mean_distance_text")]] : []),
    ["Status", runs.statuses[at("status")].replaceAll("_", " ")],
    ["Kind of motion", at("kind_text")],
    ["Lyapunov exponents", exponents.length ? element("ul", { class: "values" }, ...exponents.map((text) => element("li", {}, text))) : "none computed"],
    ...comparedRows({ law, initial, a }),
    ["File", element("a", { href: commandsOf({ law, initial, a }).path, id: "run-file" }, commandsOf({ law, initial, a }).path)],
  ];
}

const subscript = (number) => String.fromCodePoint(...[...String(number)].map((digit) => 0x2080 + Number(digit)));

/** Show a run. */
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
  redrawRuns();
  showBlocks();
}

/** Draw the charts of the runs again, where they have been drawn. */
const redrawRuns = () => drawn.forEach((box) => { if ("law" in box.dataset) draw(box); });

/** Show a run that the reader picks, and put it into the address once the choice rests. */
function choose(...run) {
  pick(...run);
  clearTimeout(picked.timer);
  picked.timer = setTimeout(() => {
    picked.timer = 0;
    location.hash = runAddress();
  }, 300);
}

const runAddress = () => "run=" + [runs.laws[picked.law], runs.initial[picked.initial], runs.texts[picked.a]].map(encodeURIComponent).join("/");

/** Show the run of an address, or the first run of the page if it has none; return whether it is another run. */
function pickFrom(address) {
  const names = address.split("/").map(decodeURIComponent);
  const run = address ? [runs.laws, runs.initial, runs.texts].map((list, n) => list.indexOf(names[n])) : runs.first;
  if (run.includes(-1) || run.join() === [picked.law, picked.initial, picked.a].join()) return false;
  pick(...run);
  return true;
}

/** Mark the picked run in a chart of the runs of its law, and show the branches if the reader wants them. */
function markPicked(box, figure) {
  for (const trace of figure.data) if (trace.meta === "branch") trace.visible = byId("branches").checked;
  if (Number(box.dataset.law) !== picked.law) return;
  const y = runs.mean_distance[picked.law][picked.initial][picked.a];
  Object.assign(figure.data.at(-1), { x: [runs.a[picked.a]], y: [typeof y === "number" ? y : 0] });
}

const clamp = (value, size) => Math.min(Math.max(value, 0), size - 1);
const moved = (initial, a) => [clamp(picked.initial + initial, runs.initial.length), clamp(picked.a + a, runs.a.length)];
const step = (a) => choose(picked.law, ...moved(0, a));

/** Let a chart of runs be picked on, by pointer and by arrow keys. */
function connectRuns(box) {
  if (!("law" in box.dataset)) return;
  box.on("plotly_click", ({ points }) => {
    const run = points.find((point) => point.data.meta === "run");
    if (run) choose(Number(box.dataset.law), run.customdata[0], run.pointNumber);
  });
  const moves = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] };
  box.addEventListener("keydown", (event) => {
    const move = moves[event.key];
    if (!move || event.altKey || event.ctrlKey || event.metaKey || event.target !== box) return;
    event.preventDefault();
    choose(Number(box.dataset.law), ...moved(...move));
  });
}

/** Copy the values of the picked run and its commands as lines of text. */
async function copyRun() {
  const text = [...document.querySelectorAll("#run-detail div")].map((row) =>
    [...row.children].map((cell) => cell.innerText.replaceAll("\n", ", ")).join(": "));
  const lines = [...text, byId("run-snakemake").textContent, byId("run-simulate").textContent].join("\n");
  let copied = true;
  try {
    await navigator.clipboard.writeText(lines);
  } catch {
    // Without a clipboard the browser copies what is selected.
    const area = element("textarea", { class: "visually-hidden" }, lines);
    byId("run").append(area);
    area.select();
    copied = document.execCommand("copy");
    area.remove();
  }
  byId("copied").textContent = copied ? "Copied." : "This browser does not let the page copy.";
}

function startRuns() {
  const fill = (id, names) => byId(id).replaceChildren(...names.map((name, n) => element("option", { value: n }, name)));
  const lists = ["run-law", "run-initial", "run-a"];
  [runs.laws, runs.initial, runs.texts].forEach((names, n) => fill(lists[n], names));
  for (const id of lists) byId(id).addEventListener("change", () => choose(...lists.map((name) => Number(byId(name).value))));
  byId("run-previous").addEventListener("click", () => step(-1));
  byId("run-next").addEventListener("click", () => step(1));
  byId("run-copy").addEventListener("click", copyRun);
  const showBranches = () => {
    document.querySelectorAll(".legend.branches").forEach((legend) => { legend.hidden = !byId("branches").checked; });
    redrawRuns();
  };
  if (!byId("branches")) return;
  byId("branches").addEventListener("change", showBranches);
  showBranches();
}
