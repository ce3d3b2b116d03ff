// ⟨J⟩ of runs and attractors, exponents, and basin fractions, against a.
const branchShapes = ["circle", "square", "diamond", "triangle-up", "triangle-down", "cross", "star", "hexagon", "pentagon"];
const runShapes = ["circle", "triangle-down", "square", "triangle-up", "diamond", "pentagon", "hexagon2", "x"];

/** The groups of the legend in order, each with a shape of its own; branches of small basins share one. */
const groups = new Map();
for (const branch of data.branches)
  if (!groups.has(branch.group))
    groups.set(branch.group, { name: branch.group, color: branch.color, shape: branch.group === "other branches" ? "x" : branchShapes[groups.size % branchShapes.length] });
const groupOf = (number) => groups.get(branchOf.get(number).group);

const runShape = (n) => runShapes[n % runShapes.length] + (n % 2 ? "-open" : "");

legends.branches = () => [...groups.values()].map((group) => ({ ...group, color: hue(group.color) }));
legends.runs = () => [
  ...runs.initial.map((name, n) => ({ name: `run from ${name}`, color: ink("text"), shape: runShape(n) })),
  { name: "the run shown under One run", color: ink("focus"), shape: "circle-open" },
];

builders.distance = (box) => {
  const law = Number(box.dataset.law);
  const points = data.attractors[law];
  const attractors = [...groups.values()].map((group) => {
    const chosen = points.branch.flatMap((number, n) => (groupOf(number) === group ? [n] : []));
    return {
      type: "scatter", mode: "markers", meta: "attractor",
      x: chosen.map((n) => points.a[n]), y: chosen.map((n) => points.mean_distance[n]),
      text: chosen.map((n) => `${branchOf.get(points.branch[n]).name}, ${kindOf.get(points.kind[n]).name}`),
      marker: { color: hue(group.color), symbol: group.shape, size: 8, opacity: 0.6 },
      hovertemplate: "attractor: %{text}<br>a = %{x}<br>⟨J⟩ = %{y:.5g}<extra></extra>",
    };
  });
  const curves = runs.initial.map((name, initial) => ({
    type: "scatter", mode: "lines+markers", meta: "run",
    x: runs.a, y: runs.mean_distance[law][initial].map(plain),
    customdata: runs.a.map((_, n) => [initial, n, kindOf.get(runs.kind[law][initial][n]).name, runs.mean_distance_text[law][initial][n]]),
    error_y: { type: "data", array: runs.mean_distance_error[law][initial].map((error) => 3 * (plain(error) ?? 0)), thickness: 0.8, width: 0, color: ink("text") },
    line: { color: ink("text"), width: 0.8 },
    marker: { color: ink("text"), symbol: runShape(initial), size: 5 },
    hovertemplate: `run from ${name}: %{customdata[2]}<br>a = %{x}<br>⟨J⟩ = %{customdata[3]}<extra></extra>`,
  }));
  const here = picked.law === law;
  const mark = {
    type: "scatter", mode: "markers", hoverinfo: "skip", meta: "picked",
    x: here ? [runs.a[picked.a]] : [], y: here ? [plain(runs.mean_distance[law][picked.initial][picked.a]) ?? 0] : [],
    marker: { symbol: "circle-open", size: 15, color: ink("focus"), line: { width: 2.5 } },
  };
  return { traces: [...attractors.filter((trace) => trace.x.length), ...curves, mark], xaxis: aAxis(), yaxis: axis("⟨<i>J</i>⟩", { range: distanceRange() }) };
};

/** All laws share the range of ⟨J⟩. */
function distanceRange() {
  const found = greatest([...tops(runs.mean_distance.flat(2), runs.mean_distance_error.flat(2)), ...data.attractors.flatMap((law) => law.mean_distance.map(plain))]);
  // Where all is 0, rounding sets the scale of nothing.
  const largest = found > 1e-9 ? found : 0.01;
  return [-0.04 * largest, 1.06 * largest];
}

/** Return the greatest of any number of values, 0 at least. */
const greatest = (values) => values.reduce((one, other) => Math.max(one, other), 0);

/** Return where the bars of three errors end; where there is no value, 0. */
const tops = (values, errors) => values.map((value, n) => plain(value) + 3 * plain(errors[n]));

legends.kinds = () => [
  ...runs.exponents[0][0][0].slice(0, 3).map((_, n) => ({ name: `λ${subscript(n + 1)}`, color: grey(n), shape: "circle" })),
  ...data.kinds.filter((kind) => runs.kind.flat(2).includes(kind.number)).map((kind) => ({ name: kind.name, color: kind.color, shape: "patch", edge: ink("muted") })),
];
const grey = (n) => (isDark() ? ["#f2f4f6", "#b4bac0", "#7e868e"] : ["#000000", "#5f666d", "#9aa1a8"])[n];

builders.exponents = (box) => {
  const [law, initial] = [Number(box.dataset.law), Number(box.dataset.initial)];
  const exponents = runs.exponents[law][initial];
  const errors = runs.exponent_errors[law][initial];
  const curves = exponents[0].slice(0, 3).map((_, n) => ({
    type: "scatter", mode: "lines+markers",
    x: runs.a, y: exponents.map((values) => plain(values[n])),
    text: runs.exponent_texts[law][initial].map((texts) => texts[n]),
    error_y: { type: "data", array: errors.map((values) => 3 * (plain(values[n]) ?? 0)), thickness: 0.8, width: 0, color: grey(n) },
    line: { color: grey(n), width: 0.8 }, marker: { color: grey(n), size: 4 },
    hovertemplate: `a = %{x}<br>λ${subscript(n + 1)} = %{text}<extra></extra>`,
  }));
  const order = data.kinds.map((kind) => kind.number);
  const last = Math.max(1, order.length - 1);
  const strip = {
    type: "heatmap", x: aEdges, y: [0, 1], yaxis: "y2", zmin: 0, zmax: last,
    z: [runs.kind[law][initial].map((kind) => order.indexOf(kind))],
    text: [runs.kind[law][initial].map((kind, n) => `a = ${runs.texts[n]}: ${kindOf.get(kind).name}`)],
    colorscale: steps(data.kinds.map((kind) => kind.color)), showscale: false,
    hovertemplate: "%{text}<extra></extra>",
  };
  return {
    traces: [...curves, strip],
    xaxis: aAxis(),
    yaxis: axis("Lyapunov exponents", { range: [-0.13, Math.max(0.08, 1.1 * greatest(tops(runs.exponents.flat(3), runs.exponent_errors.flat(3))))], domain: [0, 0.92] }),
    yaxis2: { domain: [0.945, 1], visible: false, fixedrange: true },
    shapes: [{ type: "line", xref: "paper", x0: 0, x1: 1, y0: 0, y1: 0, layer: "below", line: { color: ink("muted"), width: 1 } }],
  };
};

/** Return a colour scale of equal steps: whole numbers 0 … n − 1 have one colour each, between zmin = 0 and zmax = n − 1. */
function steps(colors) {
  const size = Math.max(2, colors.length);
  const stop = (value) => Math.min(1, Math.max(0, (value - 0.5) / (size - 1)));
  return colors.flatMap((color, n) => [[stop(n), color], [n === colors.length - 1 ? 1 : stop(n + 1), color]]);
}

builders.fractions = (box) => {
  const traces = data.fractions[Number(box.dataset.law)].flatMap((curve) => {
    const color = hue(curve.color);
    const group = groups.get(curve.name);
    return [
      { type: "scatter", mode: group ? "lines+markers" : "markers", x: runs.a, y: curve.fraction,
        text: curve.fraction.map((_, n) => `${short(curve.low[n])} to ${short(curve.high[n])}`),
        error_y: { type: "data", symmetric: false, array: curve.fraction.map((value, n) => (value === null ? 0 : curve.high[n] - value)),
          arrayminus: curve.fraction.map((value, n) => (value === null ? 0 : value - curve.low[n])), color: translucent(color, 0.45), thickness: 1.2, width: 0 },
        line: { color, width: 1 }, marker: { color, size: 5, symbol: group?.shape ?? "x-thin-open" },
        hovertemplate: `${curve.name}<br>a = %{x}<br>fraction %{y:.4g} (%{text})<extra></extra>` },
    ];
  });
  return { traces, xaxis: aAxis(), yaxis: axis("fraction of initial states", { range: [-0.03, 1.03] }) };
};

builders.conventions = (box) => {
  const rows = data.conventions.branch[Number(box.dataset.law)];
  const all = [...groups.values()];
  const trace = {
    type: "heatmap", x: aEdges, y: data.conventions.names, zmin: 0, zmax: Math.max(1, all.length - 1),
    z: rows.map((row) => row.map((number) => (branchOf.has(number) ? all.indexOf(groupOf(number)) : null))),
    text: rows.map((row, n) => row.map((number, k) => `${data.conventions.names[n]}<br>a = ${runs.texts[k]}: ${branchOf.get(number)?.name ?? "undetermined"}`)),
    colorscale: steps(all.map((group) => hue(group.color))), showscale: false, hoverongaps: true, ygap: 2,
    hovertemplate: "%{text}<extra></extra>",
  };
  const narrow = box.clientWidth < 480;
  return {
    traces: [trace], xaxis: aAxis({ showgrid: false }),
    yaxis: axis("", { autorange: "reversed", showgrid: false, ticks: "", tickfont: { size: narrow ? 10 : 12 }, automargin: true }),
    margin: { l: 10, r: 18, t: 30, b: 48 },
  };
};
