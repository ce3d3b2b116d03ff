// One law compared with the first one, for one initial state.
const toleranceStyles = () => [
  { key: "difference", name: "difference between the laws", color: hue("#0072B2"), dash: "solid", shape: "circle" },
  { key: "noise", name: `${shown(data.agreement.standard_errors)} standard errors of it`, color: hue("#D55E00"), dash: "dash", shape: "dash" },
  { key: "share", name: `${shown(data.agreement.percent)} % of ⟨J⟩`, color: hue("#009E73"), dash: "dot", shape: "dot" },
];

legends.agreement = () => [
  ...toleranceStyles(),
  { name: "the laws disagree", color: ink("line"), shape: "patch", edge: ink("muted") },
];

builders.agreement = (box) => {
  const [law, initial] = [Number(box.dataset.law), Number(box.dataset.initial)];
  const { agreement } = data;
  const verdict = runs.agrees[law][initial].map((value) => agreementWords[value]);
  const curve = (y, color, dash, name, more = {}) => ({
    type: "scatter", mode: dash === "solid" ? "lines+markers" : "lines", x: runs.a, y, text: verdict,
    line: { color, dash, width: 1.3 }, marker: { color, size: 4 },
    hovertemplate: `${name}<br>a = %{x}<br>%{y:.4g}<br>%{text}<extra></extra>`, ...more,
  });
  const main = hue("#0072B2");
  const shaded = runs.agrees[law][initial].flatMap((value, n) => (value === 0 ? [{
    type: "rect", xref: "x", yref: "paper", x0: aEdges[n], x1: aEdges[n + 1], y0: 0, y1: 1, layer: "below", line: { width: 0 }, fillcolor: translucent(isDark() ? "#a9b0b7" : "#565c63", 0.2),
  }] : []));
  // Differences of synchronized runs are rounding; they set the scale of nothing.
  const above = (values, least) => [least, Math.max(0, powers(values.flat(2))[1])];
  return {
    traces: [
      ...toleranceStyles().map(({ key, color, dash, name }) => curve(agreement[key][law][initial], color, dash, name)),
      curve(agreement.section_distance[law][initial], main, "solid", "Wasserstein distance of W′", { yaxis: "y2" }),
      curve(agreement.event_order_time[law][initial], main, "solid", "same order of events until τ", { yaxis: "y3" }),
    ],
    xaxis: aAxis({ anchor: "y3", mirror: "all" }),
    yaxis: logarithmic("|Δ⟨<i>J</i>⟩|", above(agreement.difference, -15), { domain: [0.7, 1] }),
    yaxis2: logarithmic("distance of <i>W</i>′", above(agreement.section_distance, -8), { domain: [0.35, 0.65] }),
    yaxis3: logarithmic("same order until <i>τ</i>", powers(agreement.event_order_time.flat(2), 0, 1), { domain: [0, 0.3] }),
    shapes: shaded,
    margin: { l: 72, r: 18, t: 30, b: 48 },
  };
};
