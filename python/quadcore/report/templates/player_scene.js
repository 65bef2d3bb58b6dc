// The camera and everything that is drawn on the canvas.

const canvas = part("canvas");
const pen = canvas.getContext("2d");

// ---- camera ----

const view = { azimuth: -1.0, elevation: 0.45, distance: 1, target: [0, 0, 0] };
let scene;  // bounding box (low, high), height of the grid (floor) and edge of its squares

function fit() {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const flight of shown().length ? shown() : flights) {
    // With a reference, that alone sets the view: a diverged vehicle may leave it.
    const guided = flight.reference && flight.reference.some(Number.isFinite);
    const points = guided ? flight.reference : flight.position;
    for (let i = 0; i < points.length; ++i) {
      if (!Number.isFinite(points[i])) continue;
      low[i % 3] = Math.min(low[i % 3], points[i]);
      high[i % 3] = Math.max(high[i % 3], points[i]);
    }
  }
  const size = Math.max(0.5, ...difference(high, low));
  const power = 10 ** Math.floor(Math.log10(size / 4));
  const square = power * [1, 2, 5].reduce((best, n) => (n * power <= size / 4 ? n : best), 1);
  view.target = low.map((value, i) => (value + high[i]) / 2);
  view.distance = 1.4 * Math.hypot(...difference(high, low), size);
  scene = { low, high, square, floor: square * Math.floor(low[2] / square) };
}

// Project a point of the world to the canvas; null behind the camera.
function camera(width, height) {
  const [sa, ca] = [Math.sin(view.azimuth), Math.cos(view.azimuth)];
  const [se, ce] = [Math.sin(view.elevation), Math.cos(view.elevation)];
  const toward = [ce * ca, ce * sa, se], right = [-sa, ca, 0], up = [-se * ca, -se * sa, ce];
  const focal = 1.5 * Math.min(width, height);
  return (point) => {
    const d = difference(point, view.target);
    const depth = view.distance - dot(d, toward);
    if (!(depth > 0.02 * view.distance)) return null;
    const scale = focal / depth;
    return [width / 2 + scale * dot(d, right), height / 2 - scale * dot(d, up), scale];
  };
}

// ---- drawing ----

let project;

// Draw a line through points of the world; `point(i)` returns the i-th.
function line(count, point, first = 0) {
  pen.beginPath();
  let down = false;
  for (let i = first; i < count; ++i) {
    const p = project(point(i));
    if (!p) { down = false; continue; }
    if (down) pen.lineTo(p[0], p[1]); else pen.moveTo(p[0], p[1]);
    down = true;
  }
  pen.stroke();
}

const column = (values) => (i) => [values[3 * i], values[3 * i + 1], values[3 * i + 2]];

function style(colour, width, alpha = 1, dash = []) {
  pen.strokeStyle = pen.fillStyle = colour;
  pen.lineWidth = width;
  pen.globalAlpha = alpha;
  pen.setLineDash(dash);
}

function drawGrid(ink) {
  const { low, high, square, floor: z } = scene;
  const from = [0, 1].map((i) => square * (Math.floor(low[i] / square) - 1));
  const to = [0, 1].map((i) => square * (Math.ceil(high[i] / square) + 1));
  style(ink, 1, 0.15);
  const across = [0, 1].map((axis) => Math.round((to[axis] - from[axis]) / square));
  for (let n = 0; n <= across[0]; ++n)
    line(2, (i) => [from[0] + n * square, i ? to[1] : from[1], z]);
  for (let n = 0; n <= across[1]; ++n)
    line(2, (i) => [i ? to[0] : from[0], from[1] + n * square, z]);
  style(ink, 1, 0.7);
  pen.font = "12px system-ui, sans-serif";
  ["x", "y", "z"].forEach((name, axis) => {
    const tip = [from[0], from[1], z];
    tip[axis] += square;
    line(2, (i) => (i ? tip : [from[0], from[1], z]));
    const p = project(tip);
    if (p) pen.fillText(name, p[0] + 4, p[1] - 4);
  });
  const digits = Math.max(0, -Math.floor(Math.log10(square)));
  pen.fillText(
    `grid at z = ${z.toFixed(digits)} m, ${square.toFixed(digits)} m squares`, 10, 20);
}

function drawTrack(flight, row, ink) {
  if (flight.reference) {
    style(ink, 1.2, 0.55, [5, 5]);
    line(flight.rows, column(flight.reference));
  }
  style(flight.colour, 1.2, 0.3, flight.dash);
  line(flight.rows, column(flight.position));
  style(flight.colour, 2, 1, flight.dash);
  line(row + 1, column(flight.position));
}

function drawVehicle(flight, now, ink) {
  const seen = project(now.position);
  if (!seen) return;
  const reach = Math.max(0.01, ...flight.rotors.map((place) => Math.hypot(...place)));
  const larger = Math.max(1, 22 / (reach * seen[2]));
  const of = (place) => now.turn.map((row, i) => now.position[i] + larger * dot(row, place));
  const gap = Math.min(...flight.rotors.map((a, i) => Math.min(reach, ...flight.rotors.map(
    (b, j) => (i === j ? reach : 0.45 * Math.hypot(...difference(a, b)))))));
  const alpha = started(flight) && !ended(flight) ? 1 : 0.45;
  style(flight.colour, 1, 0.4 * alpha);
  line(2, (i) => (i ? now.position : [now.position[0], now.position[1], scene.floor]));
  flight.rotors.forEach((place, rotor) => {
    style(flight.colour, 2.5, alpha);
    line(2, (i) => (i ? of(place) : now.position));
    style(ink, 1.2, 0.7 * alpha);
    line(25, (i) => of([
      place[0] + gap * Math.cos(i * Math.PI / 12), place[1] + gap * Math.sin(i * Math.PI / 12),
      place[2]]));
    if (rotor < flight.turning) {
      const height = 0.7 * reach * Math.min(4, (now.speeds[rotor] / flight.usual) ** 2);
      style(flight.colour, 3, alpha);
      line(2, (i) => of([place[0], place[1], place[2] + i * height]));
    }
  });
  style(ink, 2, alpha);
  line(2, (i) => of([i * reach, 0, 0]));  // forward, along x of the frame
  for (const [mass, ...place] of now.carried) if (mass > 0) drawPayload(of([0, 0, 0]), of(place), ink);
  if (now.wind && Math.hypot(...now.wind) > 0) drawWind(now.position, now.wind, ink);
  if (now.reference) {
    const p = project(now.reference);
    if (!p) return;
    style(ink, 1.5, 0.8);
    pen.strokeRect(p[0] - 4, p[1] - 4, 8, 8);
  }
}

// Draw a payload that hangs on the frame.
function drawPayload(frame, place, ink) {
  const p = project(place);
  if (!p) return;
  style(ink, 1.5, 0.8);
  line(2, (i) => (i ? place : frame));
  pen.fillRect(p[0] - 5, p[1] - 5, 10, 10);
}

// Draw the wind as an arrow from the vehicle; its length does not depend on the camera distance.
function drawWind(from, wind, ink) {
  const a = project(from);
  const b = project(from.map((value, i) => value + 0.01 * wind[i]));
  if (!a || !b) return;
  const along = [0, 1].map((i) => 30 * (b[i] - a[i]) / (0.01 * a[2]));  // 30 per m/s
  const shorter = Math.min(1, 160 / Math.hypot(...along));
  const tip = [0, 1].map((i) => a[i] + shorter * along[i]);
  const angle = Math.atan2(along[1], along[0]);
  style(ink, 2, 0.8, [2, 3]);
  pen.beginPath();
  pen.moveTo(a[0], a[1]);
  pen.lineTo(tip[0], tip[1]);
  pen.stroke();
  style(ink, 2, 0.8);
  pen.beginPath();
  for (const turn of [2.7, 0, -2.7])
    pen.lineTo(tip[0] + (turn && 9 * Math.cos(angle + turn)), tip[1] + (turn && 9 * Math.sin(angle + turn)));
  pen.stroke();
}

let time = begin;
const started = (flight) => time >= flight.begin();
const ended = (flight) => time > flight.end() + 1e-3;

function draw() {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
  if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.globalAlpha = 1;
  pen.clearRect(0, 0, width, height);
  const states = new Map(flights.map((flight) => [flight, flight.at(time)]));
  if (part(".follow").checked && shown().length)
    view.target = states.get(shown()[0]).position;
  project = camera(width, height);
  const ink = getComputedStyle(canvas).color;
  drawGrid(ink);
  for (const flight of shown()) drawTrack(flight, states.get(flight).row, ink);
  for (const flight of shown()) drawVehicle(flight, states.get(flight), ink);
  part(".time").value = time;
  part(".clock").textContent = `${time.toFixed(2)} of ${end.toFixed(2)} s`;
  for (const flight of flights) updateRow(flight, states.get(flight));
}
