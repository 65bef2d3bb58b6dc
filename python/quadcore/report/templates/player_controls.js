// Controls: table, time, mouse, fingers, keys.

// ---- the table ----

function updateRow(flight, { position, reference, wind, carried }) {
  const state = !started(flight) ? " (not started)" : ended(flight) ? " (ended)" : "";
  flight.cells[0].textContent = position.map((value) => value.toFixed(3)).join(", ") + state;
  const away = reference ? 1000 * Math.hypot(...difference(position, reference)) : NaN;
  const shown = away < 1e-6 ? 0 : away;  // less is rounding noise
  flight.cells[1].textContent = reference ? String(Number(shown.toPrecision(3))) : "";
  const speed = wind ? Math.hypot(...wind) : NaN;
  flight.cells[2].textContent = Number.isFinite(speed) ? speed.toFixed(1) : "";
  const load = carried.reduce((sum, [mass]) => sum + (mass || 0), 0);
  flight.cells[3].textContent = load > 0 ? String(Number(load.toPrecision(3))) : "";
}

for (const flight of flights) {
  const row = part("tbody").insertRow();
  const label = row.insertCell().appendChild(document.createElement("label"));
  flight.box = label.appendChild(document.createElement("input"));
  Object.assign(flight.box, { type: "checkbox", checked: true });
  const dash = flight.dash.map((length) => 1.5 * length).join(" ");
  label.insertAdjacentHTML(
    "beforeend",
    '<svg class="swatch" viewBox="0 0 40 8" aria-hidden="true"><line x2="40" y1="4" y2="4" ' +
    `stroke="${flight.colour}" stroke-width="5" stroke-dasharray="${dash}"/></svg>`);
  label.append(flight.name);
  flight.cells = ["where", "away", "wind", "load"].map((column) => {
    const cell = row.insertCell();
    cell.className = column;
    return cell;
  });
  flight.box.addEventListener("change", () => show(flight, flight.box.checked));
}

function show(flight, visible) {
  flight.shown = flight.box.checked = visible;
  draw();
}

// ---- time ----

let playing = false, last;

function go(t) {
  time = Math.min(end, Math.max(begin, t));
  draw();
}

function play(on) {
  if (on && time >= end) time = begin;
  if (on && !playing) requestAnimationFrame((now) => { last = now; frame(now); });
  playing = on;
  part(".play").textContent = on ? "pause" : "play";
}

function frame(now) {
  if (!playing) return;
  go(time + (now - last) / 1000 * Number(part(".speed").value));
  last = now;
  if (time < end) requestAnimationFrame(frame); else play(false);
}

Object.assign(part(".time"), { min: begin, max: end });
part(".time").addEventListener("input", (event) => go(Number(event.target.value)));
part(".play").addEventListener("click", () => play(!playing));
part(".follow").addEventListener("change", () => { if (!part(".follow").checked) fit(); draw(); });
part(".fit").addEventListener("click", () => { part(".follow").checked = false; fit(); draw(); });

// ---- mouse, fingers, keys ----

const fingers = new Map();
const zoom = (factor) => { view.distance *= factor; draw(); };

function orbit(dx, dy) {
  view.azimuth -= dx * 0.008;
  view.elevation = Math.min(1.57, Math.max(-1.57, view.elevation + dy * 0.008));
}

function move(dx, dy) {
  const scale = view.distance / (1.5 * Math.min(canvas.clientWidth, canvas.clientHeight));
  const [sa, ca] = [Math.sin(view.azimuth), Math.cos(view.azimuth)];
  const [se, ce] = [Math.sin(view.elevation), Math.cos(view.elevation)];
  const right = [-sa, ca, 0], up = [-se * ca, -se * sa, ce];
  view.target = view.target.map((value, i) => value + scale * (up[i] * dy - right[i] * dx));
}

canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, [event.clientX, event.clientY]);
});
canvas.addEventListener("pointermove", (event) => {
  const before = fingers.get(event.pointerId);
  if (!before) return;
  const here = [event.clientX, event.clientY];
  const [dx, dy] = [here[0] - before[0], here[1] - before[1]];
  const other = [...fingers].find(([id]) => id !== event.pointerId);
  if (other) {
    const apart = (p) => Math.max(1, Math.hypot(p[0] - other[1][0], p[1] - other[1][1]));
    view.distance *= apart(before) / apart(here);
    move(dx / 2, dy / 2);
  } else if (event.shiftKey) {
    move(dx, dy);
  } else {
    orbit(dx, dy);
  }
  fingers.set(event.pointerId, here);
  draw();
});
for (const name of ["pointerup", "pointercancel"])
  canvas.addEventListener(name, (event) => fingers.delete(event.pointerId));
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  zoom(Math.exp(0.001 * event.deltaY));
}, { passive: false });

canvas.addEventListener("keydown", (event) => {
  const step = event.shiftKey ? 1 : 0.1;
  const actions = {
    " ": () => play(!playing),
    ArrowLeft: () => go(time - step),
    ArrowRight: () => go(time + step),
    Home: () => go(begin),
    End: () => go(end),
    "+": () => zoom(0.8),
    "-": () => zoom(1.25),
  };
  const nth = flights[Number(event.key) - 1];
  const action = actions[event.key] || (nth && (() => show(nth, !nth.shown)));
  if (!action || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  action();
});

// ---- start ----

if (!flights.some((flight) => flight.wind)) root.classList.add("calm");
if (!flights.some((flight) => flight.carried.length)) root.classList.add("unladen");

const wanted = /^#t=([0-9.]+)$/.exec(location.hash);  // a link to a moment
fit();
new ResizeObserver(draw).observe(canvas);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
go(wanted ? Number(wanted[1]) : begin);
