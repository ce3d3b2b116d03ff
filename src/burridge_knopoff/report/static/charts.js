// Charts, made by plotly in Python, are drawn when they come near the window, and again when the theme changes.
const drawn = new Set();

// A finger on a chart scrolls the page.
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

/** Return the figure of a chart in the colours of the theme, with the picked run marked. */
async function figureOf(box) {
  const text = await inflateText(box.dataset.figure);
  const figure = JSON.parse(text, isDark() ? (key, value) => data.dark[value] ?? value : undefined);
  Object.assign(figure.layout, { dragmode: coarse ? false : "zoom", uirevision: "keep" });
  const look = figure.layout.template.layout;
  look.xaxis.fixedrange = look.yaxis.fixedrange = coarse;
  markPicked(box, figure);
  return figure;
}

/** Load the plotting library, once. */
let library;
function loadLibrary() {
  library ??= inflateText(byId("plotly").textContent).then((source) => {
    const script = element("script");
    script.textContent = source;
    document.head.append(script);
  });
  return library;
}

/** Draw one chart; if this fails, pictures take the place of all charts. */
async function draw(box) {
  // In a closed fold a chart has no size: it is drawn when the fold opens.
  if (!box.offsetWidth) return;
  try {
    await loadLibrary();
    const { data: traces, layout } = await figureOf(box);
    const first = !drawn.has(box);
    drawn.add(box);
    await Plotly.react(box, traces, layout, config);
    if (first) connect(box);
    rove(box, 0);
    box.dataset.drawn = "";
  } catch (error) {
    document.documentElement.classList.add("no-charts");
    console.error(error);
  }
}

const buttonsOf = (box) => [...box.querySelectorAll(".modebar-btn")];

/** Put one button of a chart into the order of Tab; arrow keys lead to the others, as in every toolbar. */
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
  const watcher = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      watcher.unobserve(entry.target);
      draw(entry.target);
    }
  }, { rootMargin: "400px" });
  document.querySelectorAll(".chart").forEach((box) => watcher.observe(box));
  document.querySelectorAll("details").forEach((fold) => fold.addEventListener("toggle", () =>
    fold.querySelectorAll(".chart").forEach((box) => { if (drawn.has(box)) draw(box); })));
}
