// Charts are drawn when they come near the window, and drawn anew when the theme changes.
const builders = {};
const drawn = new Map();

// A finger on a chart scrolls the page; zooming is left to the buttons.
const coarse = window.matchMedia("(pointer: coarse)").matches;
const config = {
  responsive: true,
  displaylogo: false,
  // A page that stays offline has no button that uploads its numbers.
  showSendToCloud: false,
  // Its hints would lie over the next chart.
  showTips: false,
  plotlyServerURL: "",
  displayModeBar: coarse ? false : "hover",
  modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"],
  scrollZoom: false,
};

/** Return an axis in the look of the figures: ticks inside, lines on all sides. */
const axis = (title, more = {}) => ({
  title: { text: title, standoff: 8 },
  showline: true,
  mirror: "ticks",
  ticks: "inside",
  zeroline: false,
  linecolor: ink("muted"),
  tickcolor: ink("muted"),
  gridcolor: ink("line"),
  gridwidth: 0.5,
  minexponent: 4,
  fixedrange: coarse,
  ...more,
});

/** Return a logarithmic axis over [least, largest], powers of ten, with no more labels than a small panel holds. */
const logarithmic = (title, [least, largest], more = {}) =>
  axis(title, { type: "log", range: [least, largest], exponentformat: "power", dtick: Math.max(1, Math.ceil((largest - least) / 5)), ...more });

/** Return the powers of ten around all values that are there, at least from `least` to `largest`. */
function powers(values, least = Infinity, largest = -Infinity) {
  const logs = values.filter((value) => value > 0).map(Math.log10);
  return [Math.min(least, ...logs) - 0.1, Math.max(largest, ...logs) + 0.1];
}

const layout = (more) => ({
  font: { family: getComputedStyle(document.body).fontFamily, size: 13, color: ink("text") },
  paper_bgcolor: "rgba(0,0,0,0)",
  plot_bgcolor: "rgba(0,0,0,0)",
  margin: { l: 62, r: 18, t: 30, b: 48 },
  showlegend: false,
  hovermode: "closest",
  hoverlabel: { bgcolor: ink("background"), bordercolor: ink("muted"), font: { color: ink("text"), size: 13 }, align: "left" },
  dragmode: coarse ? false : "zoom",
  uirevision: "keep",
  modebar: { bgcolor: "rgba(0,0,0,0)", color: ink("muted"), activecolor: ink("text") },
  ...more,
});

/** Return the axis of a, with room for what is drawn at the first and at the last value. */
function aAxis(more = {}) {
  const [first, last] = [aEdges[0], aEdges.at(-1)];
  const margin = 0.02 * (last - first);
  return axis("<i>a</i>", { range: [first - margin, last + margin], nticks: 8, ...more });
}

/** Draw one chart; what goes wrong leaves the pictures in the place of all charts. */
function draw(box) {
  try {
    const { traces, ...rest } = builders[box.dataset.chart](box);
    const first = !drawn.has(box);
    drawn.set(box, true);
    const done = Plotly.react(box, traces, layout(rest), config);
    done.then(() => {
      if (first) connect(box);
      rove(box, 0);
      box.dataset.drawn = "";
    });
  } catch (error) {
    document.documentElement.classList.add("no-charts");
    console.error(error);
  }
}

const buttonsOf = (box) => [...box.querySelectorAll(".modebar-btn")];

/** Let one button of a chart be reached by Tab; arrow keys lead to the others, as in every toolbar. */
function rove(box, chosen) {
  buttonsOf(box).forEach((button, n) => { button.tabIndex = n === chosen ? 0 : -1; });
}

function connect(box) {
  connectRuns(box);
  box.addEventListener("keydown", (event) => {
    const buttons = buttonsOf(box);
    const move = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!move || !buttons.includes(event.target)) return;
    event.preventDefault();
    const next = (buttons.indexOf(event.target) + move + buttons.length) % buttons.length;
    rove(box, next);
    buttons[next].focus();
  });
}

function startCharts() {
  if (typeof Plotly === "undefined") {
    document.documentElement.classList.add("no-charts");
    return;
  }
  const watcher = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      watcher.unobserve(entry.target);
      draw(entry.target);
    }
  }, { rootMargin: "400px" });
  document.querySelectorAll(".chart").forEach((box) => watcher.observe(box));
  themeListeners.push(() => { for (const box of drawn.keys()) draw(box); });
}

// Legends are lists of the page, so that they wrap on a narrow screen and stand once for all charts of a section.
const legends = {};

const shapes = {
  circle: '<circle cx="7" cy="7" r="4.5"/>',
  "circle-open": '<circle cx="7" cy="7" r="4" fill="none" stroke-width="1.5"/>',
  square: '<rect x="2.5" y="2.5" width="9" height="9"/>',
  "triangle-down-open": '<path d="M2 3h10l-5 9z" fill="none" stroke-width="1.5"/>',
  "triangle-up": '<path d="M7 2l5.5 9.5h-11z"/>',
  "triangle-down": '<path d="M7 12l5.5-9.5h-11z"/>',
  diamond: '<path d="M7 1l6 6-6 6-6-6z"/>',
  cross: '<path d="M5 1h4v4h4v4h-4v4h-4v-4h-4v-4h4z"/>',
  star: '<path d="M7 .5l2 4.3 4.6.5-3.4 3.2.9 4.7L7 10.8l-4.1 2.4.9-4.7L.4 5.3 5 4.8z"/>',
  hexagon: '<path d="M7 1l5.2 3v6L7 13l-5.2-3V4z"/>',
  pentagon: '<path d="M7 1l6 4.4-2.3 7H3.3L1 5.4z"/>',
  x: '<path d="M2.5 2.5l9 9m0-9l-9 9" fill="none" stroke-width="2"/>',
  patch: '<rect x="1" y="1" width="12" height="12" stroke-width="1"/>',
  line: '<path d="M0 7h14" stroke-width="2"/>',
  dash: '<path d="M0 7h14" stroke-width="2" stroke-dasharray="5 3"/>',
  dot: '<path d="M0 7h14" stroke-width="2" stroke-dasharray="2 2"/>',
};

/** Return an entry of a legend: {name, color, shape, edge}. */
function legendEntry({ name, color, shape, edge }) {
  const item = element("li");
  item.innerHTML = `<svg width="14" height="14" viewBox="0 0 14 14" aria-hidden="true">${shapes[shape] ?? shapes.circle}</svg>`;
  item.firstChild.setAttribute("fill", color);
  item.firstChild.setAttribute("stroke", edge ?? color);
  item.append(name);
  return item;
}

function fillLegends() {
  document.querySelectorAll("[data-legend]").forEach((list) =>
    list.replaceChildren(...legends[list.dataset.legend](list).map(legendEntry)));
}
