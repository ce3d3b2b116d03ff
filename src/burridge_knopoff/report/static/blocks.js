// The blocks of the picked run, drawn from its trajectory: a chain pulled by the driver, which is at rest in the picture.
const trajectories = data.trajectories;
// Sizes in the units of the drawing; time units of the run per second.
const SPACING = 180, BLOCK = 62, TOP = 38, GROUND = 174, SPEED = 3;
const moving = {
  blocks: null, frames: 0, moment: 0, playing: false, request: 0, last: 0, visible: false,
  wanted: !window.matchMedia("(prefers-reduced-motion: reduce)").matches,
};

const svg = (name, attributes) => {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  byId("blocks").append(made);
  return made;
};

/** Return a spring from one point to another as a path. */
function spring(x, y, toX, toY) {
  const length = Math.hypot(toX - x, toY - y), [along, across] = [(toX - x) / length, (toY - y) / length];
  const turns = Array.from({ length: 14 }, (none, n) => [(n + 2) / 17, 5 * (n % 2 ? 1 : -1)]);
  return "M" + [[0, 0], [1 / 17, 0], ...turns, [16 / 17, 0], [1, 0]].map(([share, offset]) =>
    `${(x + share * (toX - x) - offset * across).toFixed(1)} ${(y + share * (toY - y) + offset * along).toFixed(1)}`).join("L");
}

/** Return the positions of a run in the frame of the ground, [block][frame], and the unit of a step; null without. */
async function trajectoryOf({ law, initial, a }) {
  if (a % trajectories.every) return null;
  moving.bytes ??= inflate(trajectories.packed).then((buffer) => new Int8Array(buffer));
  const bytes = await moving.bytes;
  const perState = Math.ceil(runs.a.length / trajectories.every);
  const number = (law * runs.initial.length + initial) * perState + a / trajectories.every;
  const frames = trajectories.frames[number], unit = trajectories.units[number];
  if (!frames) return null;
  let start = trajectories.frames.slice(0, number).reduce((sum, count) => sum + count * trajectories.blocks, 0);
  return trajectories.first[number].map((first) => {
    const steps = bytes.subarray(start, start += frames);
    const positions = [first];
    for (const step of steps) positions.push(positions.at(-1) + unit * step);
    return { positions, steps };
  });
}

/** Show the blocks of the picked run, or say that its trajectory is not in the page. */
async function showBlocks() {
  if (!trajectories) return;
  const { law, initial, a } = picked;
  const blocks = await trajectoryOf(picked);
  if (law !== picked.law || initial !== picked.initial || a !== picked.a) return;
  byId("moving").hidden = !blocks;
  byId("not-moving").textContent = blocks ? "" : "The trajectory of this run is not in the report. If the run completed, its file has it.";
  moving.blocks = blocks;
  setPlaying();
  if (!blocks) return;
  moving.frames = blocks[0].steps.length;
  moving.moment = 0;
  byId("moment").max = moving.frames * trajectories.interval;
  const relative = blocks.flatMap(({ positions }) =>
    positions.map((position, n) => position - trajectories.v * trajectories.interval * n));
  // There is less room on the right of the point where the driver pulls.
  const furthest = Math.max(-Math.min(...relative), 3 * Math.max(...relative));
  moving.scale = 0.55 * SPACING / (furthest || 1);
  drawBlocks();
}

/** Make the parts of the drawing, one per block, spring and line. */
function makeBlocks() {
  const count = trajectories.blocks, width = SPACING * count + 40;
  byId("blocks").setAttribute("viewBox", `0 0 ${width} ${GROUND + 22}`);
  byId("blocks").style.minWidth = `${4 * count}rem`;
  moving.anchors = Array.from({ length: count }, (none, n) => SPACING * (n + 0.75) + 20);
  svg("path", { d: `M10 ${TOP}H${width - 10}`, class: "driver" });
  // Above the driver, where no spring can reach.
  svg("path", { d: `M${width - 52} ${TOP - 20}h40m-8 -5l8 5l-8 5`, class: "line" });
  svg("text", { x: width - 64, y: TOP - 14, class: "velocity" }).textContent = "v";
  svg("path", { d: `M10 ${GROUND}H${width - 10}`, class: "line" });
  moving.ground = svg("path", { d: `M10 ${GROUND + 7}H${width - 10}`, class: "ground" });
  moving.pulling = moving.anchors.map(() => svg("path", { class: "spring pulling" }));
  moving.coupling = moving.anchors.slice(1).map(() => svg("path", { class: "spring" }));
  moving.rects = moving.anchors.map(() => svg("rect", { y: GROUND - BLOCK, width: BLOCK, height: BLOCK, rx: 3 }));
  moving.numbers = moving.anchors.map((none, n) => {
    const text = svg("text", { y: GROUND - BLOCK / 2 + 7, class: "block-number" });
    text.textContent = n + 1;
    return text;
  });
}

/** Draw the blocks at the present moment. */
function drawBlocks() {
  const place = Math.min(moving.moment / trajectories.interval, moving.frames - 1e-6), frame = Math.floor(place);
  const driven = trajectories.v * moving.moment, middle = GROUND - BLOCK / 2;
  const x = moving.blocks.map(({ positions }, n) => {
    const position = positions[frame] + (place - frame) * (positions[frame + 1] - positions[frame]);
    return moving.anchors[n] + moving.scale * (position - driven);
  });
  moving.ground.style.strokeDashoffset = moving.scale * driven;
  x.forEach((center, n) => {
    const sticks = moving.blocks[n].steps[frame] === 0;
    moving.rects[n].setAttribute("x", center - BLOCK / 2);
    moving.rects[n].setAttribute("class", sticks ? "block sticks" : "block");
    moving.numbers[n].setAttribute("x", center);
    moving.numbers[n].setAttribute("class", sticks ? "block-number sticks" : "block-number");
    if (trajectories.pulled[n]) moving.pulling[n].setAttribute("d", spring(center, GROUND - BLOCK, moving.anchors[n], TOP));
    if (n && trajectories.coupled[n - 1])
      moving.coupling[n - 1].setAttribute("d", spring(x[n - 1] + BLOCK / 2, middle, center - BLOCK / 2, middle));
  });
  byId("moment").value = moving.moment;
  byId("moment-text").textContent = `${moving.moment.toFixed(1)} of ${(moving.frames * trajectories.interval).toFixed(1)} time units`;
}

/** Play or pause: blocks move if they are in the window and the reader wants it. */
function setPlaying() {
  const playing = Boolean(moving.blocks) && moving.visible && moving.wanted;
  cancelAnimationFrame(moving.request);
  if (playing) moving.request = requestAnimationFrame((now) => { moving.last = now; advance(now); });
  moving.playing = playing;
  byId("play").textContent = playing ? "Pause" : "Play";
}

function advance(now) {
  moving.moment = (moving.moment + SPEED * (now - moving.last) / 1000) % (moving.frames * trajectories.interval);
  moving.last = now;
  drawBlocks();
  moving.request = requestAnimationFrame(advance);
}

function startBlocks() {
  if (!trajectories) return;
  makeBlocks();
  byId("play").addEventListener("click", () => { moving.wanted = !moving.playing; setPlaying(); });
  byId("moment").addEventListener("input", () => {
    moving.wanted = false;
    setPlaying();
    moving.moment = Number(byId("moment").value);
    drawBlocks();
  });
  new IntersectionObserver(([{ isIntersecting }]) => {
    moving.visible = isIntersecting;
    setPlaying();
  }).observe(byId("blocks"));
}
