// The synchronized orbit: its multipliers, and the orbits that branch off where it is lost.
const lawColors = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"];
const lawShapes = ["circle", "diamond", "square", "triangle-up", "triangle-down", "cross", "star"];
const lawColor = (n) => hue(lawColors[n % lawColors.length]);
const lawShape = (n) => lawShapes[n % lawShapes.length];

legends.orbits = () => [
  ...data.orbits.map((orbit, n) => ({ name: `${orbit.law} law`, color: lawColor(n), shape: lawShape(n) })),
  { name: "transverse μ; fitted power law", color: ink("text"), shape: "line" },
  { name: "mirror-symmetric", color: ink("text"), shape: "dash" },
];

builders.multipliers = () => {
  const traces = data.orbits.flatMap((orbit, n) => {
    const color = lawColor(n);
    const curve = (values, name, dash) => ({
      type: "scatter", mode: "lines", x: runs.a, y: values, line: { color, dash, width: 1.6 },
      hovertemplate: `${orbit.law}, ${name}<br>a = %{x}<br>%{y:.5g}<extra></extra>`,
    });
    return [
      curve(orbit.transverse, "transverse μ", "solid"),
      curve(orbit.symmetric, "mirror-symmetric", "dash"),
      { type: "scatter", mode: "markers", x: [orbit.critical_a], y: [orbit.critical_multiplier], marker: { color, size: 9, symbol: lawShape(n) },
        hovertemplate: `${orbit.law}: a<sub>c</sub> = %{x:.6g}<extra></extra>` },
    ].filter((trace) => trace.x[0] !== null);
  });
  const line = (y) => ({ type: "line", xref: "paper", x0: 0, x1: 1, y0: y, y1: y, layer: "below", line: { color: ink("muted"), width: 1 } });
  return { traces, xaxis: aAxis(), yaxis: axis("Floquet multiplier"), shapes: [line(1), line(-1)] };
};

builders.asymmetry = () => {
  const traces = data.orbits.flatMap((orbit, n) => {
    const color = lawColor(n);
    const known = orbit.offset.flatMap((value, k) => (value ? [k] : []));
    const distance = known.map((k) => Math.abs(orbit.offset[k]));
    const points = {
      type: "scatter", mode: "markers", x: distance, y: known.map((k) => orbit.asymmetry[k]), marker: { color, size: 8, symbol: `${lawShape(n)}-open` },
      hovertemplate: `${orbit.law}<br>|a − a<sub>c</sub>| = %{x:.4g}<br>|x₁ − x₃| = %{y:.4g}<extra></extra>`,
    };
    if (orbit.exponent === null) return [points];
    const fit = {
      type: "scatter", mode: "lines", x: distance, y: distance.map((value) => orbit.coefficient * value ** orbit.exponent), line: { color, width: 1 },
      hovertemplate: `${orbit.law}: exponent ${shown(orbit.exponent)}<extra></extra>`,
    };
    return [points, fit];
  });
  return {
    traces,
    xaxis: logarithmic("|<i>a</i> − <i>a</i><sub>c</sub>|", powers(traces.flatMap((trace) => trace.x))),
    yaxis: logarithmic("|<i>x</i><sub>1</sub> − <i>x</i><sub>3</sub>|", powers(traces.flatMap((trace) => trace.y))),
    margin: { l: 72, r: 18, t: 30, b: 48 },
  };
};
