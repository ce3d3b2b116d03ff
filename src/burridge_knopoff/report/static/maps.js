// Bifurcation diagrams and maps of basins, as heat maps; longer chains.
builders.sections = (box) => {
  const { edges, bins } = data.sections;
  const [law, initial] = [Number(box.dataset.law), Number(box.dataset.initial)];
  const width = (edges[1] - edges[0]) / bins;
  const y = Array.from({ length: bins + 1 }, (_, n) => edges[0] + n * width);
  const { index, count } = data.sections.runs[law][initial];
  const table = Array.from({ length: bins }, () => Array(runs.a.length).fill(0));
  let position = 0;
  index.forEach((difference, n) => { position += difference; table[position % bins][Math.floor(position / bins)] = count[n]; });
  // The share of the crossings of a run, on a logarithmic scale: 1 in 10 000 is pale, all in one bin is full.
  const totals = runs.a.map((_, k) => table.reduce((sum, row) => sum + Math.abs(row[k]), 0));
  const shade = (value, k) => Math.max(0, 4 + Math.log10(Math.abs(value) / totals[k]));
  // Cells of one width are drawn as a picture, fast and sharp.
  const layer = (sign, color) => ({
    type: "heatmap", x: cells(runs.a), y, zmin: 0, zmax: 4, showscale: false, hoverongaps: false,
    z: table.map((row) => row.map((value, k) => (sign * value > 0 ? shade(value, k) : null))),
    text: table.map((row) => row.map((value, k) => (sign * value > 0 ? `${Math.abs(value)} of ${totals[k]} crossings` : ""))),
    colorscale: [[0, translucent(hue(color), 0.35)], [0.5, hue(color)], [1, hue(color)]],
    hovertemplate: `a = %{x}<br>W′ = %{y:.4f}<br>%{text}, ${sign > 0 ? "upward" : "downward"}<extra></extra>`,
  });
  return { traces: [layer(1, "#0072B2"), layer(-1, "#D55E00")], xaxis: aAxis(), yaxis: axis("<i>W</i>′ at <i>W</i> = 0", { range: [edges[0] - 8 * width, edges[1] + 8 * width] }) };
};

legends.map = (list) => data.basins.maps[Number(list.dataset.map)].classes.map((item) => ({ name: `${item.name}: ${shown(item.percent.toFixed(2))} %`, color: item.color, shape: "patch", edge: ink("muted") }));

builders.map = (box) => {
  const { blocks, first, last, marked, maps } = data.basins;
  const { classes, label, time } = maps[Number(box.dataset.map)];
  const labels = bytes(label);
  const view = new DataView(bytes(time).buffer);
  const rows = last.map((_, r) => r * first.length);
  const decided = (n) => { const value = view.getUint16(2 * n, true); return value ? `, certain at τ = ${value}` : ""; };
  const trace = {
    type: "heatmap", x: first, y: last, zmin: 0, zmax: Math.max(1, classes.length - 1), showscale: false,
    z: rows.map((start) => Array.from(labels.subarray(start, start + first.length))),
    text: rows.map((start) => first.map((_, k) => classes[labels[start + k]].name + decided(start + k))),
    colorscale: steps(classes.map((item) => item.color)),
    hovertemplate: `U<sub>1</sub>(0) = %{x:.4f}, U<sub>${blocks}</sub>(0) = %{y:.4f}<br>%{text}<extra></extra>`,
  };
  const states = {
    type: "scatter", mode: "markers+text", x: marked.map((state) => state.first), y: marked.map((state) => state.last),
    text: marked.map((state) => `<b>${state.name}</b>`), textposition: marked.map((state) => (state.first > 0.5 * (first[0] + first.at(-1)) ? "top left" : "top right")),
    textfont: { color: "#000000", shadow: "0 0 3px #fff, 0 0 3px #fff, 0 0 3px #fff" },
    marker: { size: 9, color: "#ffffff", line: { color: "#000000", width: 1.5 } },
    hovertemplate: `%{text}<br>U<sub>1</sub>(0) = %{x}, U<sub>${blocks}</sub>(0) = %{y}<extra></extra>`,
  };
  const [x, y] = [cells(first), cells(last)];
  return {
    traces: [trace, states],
    xaxis: axis("<i>U</i><sub>1</sub>(0)", { range: [x[0], x.at(-1)], showgrid: false, constrain: "domain" }),
    yaxis: axis(`<i>U</i><sub>${blocks}</sub>(0)`, { range: [y[0], y.at(-1)], showgrid: false, scaleanchor: "x", constrain: "domain" }),
  };
};

builders.chains = (box) => {
  const law = Number(box.dataset.law);
  const { blocks, a, fraction, low, high, undetermined } = data.chains;
  const at = (values, row, k) => short(values[law][row][k]);
  const dark = isDark();
  const trace = {
    type: "heatmap", x: a.map(String), y: blocks.map(String), z: fraction[law], zmin: 0, zmax: 1, xgap: 1, ygap: 1,
    colorscale: [[0, dark ? "#2a3036" : "#eef0f2"], [0.02, dark ? "#1d4f73" : "#cfe3f1"], [1, dark ? "#7cc4f5" : "#00446b"]],
    colorbar: { title: { text: "fraction", side: "right" }, thickness: 10, outlinewidth: 0, tickfont: { size: 11 } },
    text: fraction[law].map((row, n) => row.map((_, k) => `fraction ${at(fraction, n, k)}, ${at(low, n, k)} to ${at(high, n, k)}<br>undetermined ${at(undetermined, n, k)}`)),
    hovertemplate: "N = %{y}, a = %{x}<br>%{text}<extra></extra>",
  };
  const open = blocks.flatMap((_, n) => a.flatMap((_, k) => (undetermined[law][n][k] > 0 ? [[n, k]] : [])));
  const marks = {
    type: "scatter", mode: "text", hoverinfo: "skip", x: open.map(([, k]) => String(a[k])), y: open.map(([n]) => String(blocks[n])),
    text: open.map(() => "?"), textfont: { size: 12, color: open.map(([n, k]) => (fraction[law][n][k] > 0.4 ? ink("background") : ink("text"))) },
  };
  return {
    traces: [trace, marks],
    xaxis: axis("<i>a</i>", { type: "category", range: [-0.5, a.length - 0.5], showgrid: false, tickangle: -45, ticks: "", nticks: 12 }),
    yaxis: axis("blocks <i>N</i>", { type: "category", range: [-0.5, blocks.length - 0.5], showgrid: false, ticks: "" }),
    margin: { l: 52, r: 8, t: 30, b: 62 },
  };
};
