// The player: one for each section of class quadcore-player.

import { fillNumbers, inflate, readNumbers } from "./data.js";
import { Flight } from "./flight.js";
import { listen } from "./live.js";
import { Plots } from "./plots.js";
import { download, makeGif, recordVideo } from "./recorder.js";
import { Scene } from "./scene.js";

const PLOTS_EVERY = 500;  // ms, between two drawings of the plots of a flight that goes on

class Player {
  constructor(root, content) {
    this.root = root;
    this.flights = content.flights.map((flight) => new Flight(flight));
    this.scene = new Scene(this.part(".view"), this.flights, content);
    this.playing = false;
    this.isLive = Boolean(content.live);
    this.measureTime();
    this.makeLegend();
    this.plots = new Plots(this.part(".plots"), content.plots, this.flights, content.palette);
    this.bindControls();
    this.bindKeys();
    this.bindPlots();
    this.scene.onrender = () => this.placeNames();
    new ResizeObserver(() => this.resize()).observe(this.part(".view"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", (event) => {
      this.scene.setTheme(event.matches);
      this.plots.build(this.scene.followed);
      this.draw();
    });
    const wanted = /^#t=([0-9.]+)$/.exec(location.hash);  // a link to a moment
    this.go(wanted ? Number(wanted[1]) : this.begin);
    this.scene.setCamera(content.camera);
    this.scene.resize();
    this.plots.resize();  // their own height may have made the page scroll
    if (this.isLive) this.follow(content);
  }

  part(name) { return this.root.querySelector(name); }

  measureTime() {
    const flown = this.flights.filter((flight) => flight.rows);
    this.begin = flown.length ? Math.min(...flown.map((flight) => flight.begin)) : 0;
    this.end = flown.length ? Math.max(...flown.map((flight) => flight.end)) : 0;
    Object.assign(this.part(".time"), { min: this.begin, max: Math.max(this.end, this.begin + 1e-3) });
  }

  // ---- time ----

  go(t) {
    this.time = Math.min(this.end, Math.max(this.begin, t));
    this.draw();
  }

  draw() {
    this.scene.show(this.time);
    this.part(".time").value = this.time;
    this.part(".time").setAttribute("aria-valuetext", `${this.time.toFixed(2)} s`);
    this.part(".clock").textContent = `${this.time.toFixed(2)} of ${this.end.toFixed(2)} s`;
    this.plots.show(this.time);
    this.scene.actors.forEach((actor, i) => this.updateRow(this.rows[i], actor.now));
  }

  play(on) {
    if (on && this.time >= this.end && !this.isLive) this.go(this.begin);
    if (on && !this.playing) requestAnimationFrame((now) => { this.last = now; this.frame(now); });
    this.playing = on;
    this.part(".play").textContent = on ? "Pause" : "Play";
  }

  frame(now) {
    if (!this.playing) return;
    const passed = (now - this.last) / 1000 * Number(this.part(".speed").value);
    this.last = now;
    if (this.time + passed >= this.end && this.part(".loop").checked && !this.isLive) this.go(this.begin);
    else this.go(this.time + passed);
    this.scene.render();  // in this frame of the screen, not the next
    if (this.time < this.end || this.isLive) requestAnimationFrame((next) => this.frame(next));
    else this.play(false);
  }

  // ---- legend ----

  makeLegend() {
    this.rows = this.flights.map((flight) => {
      const row = this.part("tbody").insertRow();
      const label = row.insertCell().appendChild(document.createElement("label"));
      const box = label.appendChild(document.createElement("input"));
      Object.assign(box, { type: "checkbox", checked: true });
      const dash = flight.dash.map((length) => 1.5 * length).join(" ");
      label.insertAdjacentHTML(
        "beforeend",
        '<svg class="swatch" viewBox="0 0 40 8" aria-hidden="true"><line x2="40" y1="4" y2="4" ' +
        `stroke="${flight.colour}" stroke-width="5" stroke-dasharray="${dash}"/></svg>`);
      label.append(flight.name);
      const cells = ["where", "away", "wind", "load"].map((column) => {
        const cell = row.insertCell();
        cell.className = column;
        return cell;
      });
      const follow = row.insertCell().appendChild(document.createElement("button"));
      Object.assign(follow, { type: "button", textContent: "follow" });
      follow.setAttribute("aria-label", `follow ${flight.name}`);
      follow.addEventListener("click", () => this.followFlight(flight));
      box.addEventListener("change", () => this.showFlight(flight, box.checked));
      const name = this.part(".names").appendChild(document.createElement("span"));
      name.textContent = flight.name;
      name.style.borderColor = flight.colour;
      return { box, cells, name };
    });
    if (!this.flights.some((flight) => flight.columns.wind)) this.root.classList.add("calm");
    if (!this.flights.some((flight) => flight.payloads.length)) this.root.classList.add("unladen");
    if (!this.flights.some((flight) => flight.columns.reference)) this.root.classList.add("unguided");
    if (this.flights.length === 1) this.root.classList.add("single");
  }

  updateRow({ cells }, now) {
    if (!now) return;
    const { position, reference, wind, payloads, state } = now;
    cells[0].textContent = position.map((value) => value.toFixed(3)).join(", ") + (state && ` (${state})`);
    const away = reference
      ? 1000 * Math.hypot(...position.map((value, i) => value - reference[i])) : NaN;
    cells[1].textContent = Number.isFinite(away) ? String(away < 1e-3 ? 0 : Number(away.toPrecision(3))) : "";
    const speed = wind ? Math.hypot(...wind) : NaN;
    cells[2].textContent = Number.isFinite(speed) ? speed.toFixed(1) : "";
    const load = payloads.reduce((sum, [mass]) => sum + (mass || 0), 0);
    cells[3].textContent = load > 0 ? String(Number(load.toPrecision(3))) : "";
  }

  showFlight(flight, isShown) {
    flight.shown = isShown;
    this.rows[this.flights.indexOf(flight)].box.checked = isShown;
    this.plots.build(this.scene.followed);
    this.draw();
  }

  followFlight(flight) {
    this.scene.followed = flight;
    this.plots.build(flight);
    if (!["follow", "chase"].includes(this.scene.camera)) this.part(".camera").value = "follow";
    this.scene.setCamera(this.part(".camera").value);
    this.draw();
  }

  /** Write the names beside the vehicles, one below the other where they would overlap. */
  placeNames() {
    const taken = [];
    this.scene.actors.forEach((actor, i) => {
      const { name } = this.rows[i];
      const place = this.flights.length > 1 && this.part(".show-names").checked && this.scene.locate(actor);
      name.hidden = !place;
      if (!place) return;
      let [x, y] = [place[0] + 22, place[1] - 30];
      while (taken.some(([tx, ty]) => Math.abs(tx - x) < 110 && Math.abs(ty - y) < 18)) y += 18;
      taken.push([x, y]);
      name.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    });
  }

  // ---- controls ----

  bindControls() {
    const on = (name, event, act) => this.part(name).addEventListener(event, act);
    on(".time", "input", (event) => { this.isAtEnd = false; this.go(Number(event.target.value)); });
    on(".play", "click", () => this.play(!this.playing));
    on(".camera", "change", (event) => { this.scene.setCamera(event.target.value); this.draw(); });
    for (const option of ["trails", "reference", "thrust"]) {
      on(`.show-${option}`, "change", (event) => {
        this.scene.options[option] = event.target.checked;
        this.draw();
      });
    }
    on(".show-names", "change", () => this.placeNames());
    on(".save-gif", "click", () => {
      this.tell("");
      try {
        download(this.makeGif(), "flight.gif", "image/gif");
      } catch (error) {
        this.tell(`The GIF cannot be made: ${error.message}. Save a video instead.`);
      }
    });
    on(".save-video", "click", () => this.saveVideo());
  }

  makeGif() {
    this.play(false);
    const was = this.time;
    try {
      return makeGif(this.scene, this.begin, this.end);
    } finally {
      this.go(was);
    }
  }

  tell(text) { this.part(".state").textContent = text; }

  saveVideo() {
    this.tell("");
    this.go(this.begin);
    let stop;
    try {
      stop = recordVideo(this.scene.canvas, (video) => {
        this.part(".save-video").disabled = false;
        download(video, "flight.webm", "video/webm");
      });
    } catch (error) {
      this.tell(`This browser cannot record a video: ${error.message}. Save a GIF instead.`);
      return;
    }
    this.part(".save-video").disabled = true;
    this.play(true);
    const wait = () => (this.playing ? setTimeout(wait, 100) : stop());
    wait();
  }

  bindKeys() {
    document.addEventListener("keydown", (event) => {
      if (Player.active() !== this || event.ctrlKey || event.altKey || event.metaKey) return;
      const { tagName, type } = event.target;
      const isTyping = ["SELECT", "TEXTAREA"].includes(tagName) || (tagName === "INPUT" && type !== "checkbox");
      if (isTyping || (["BUTTON", "A", "SUMMARY", "INPUT"].includes(tagName) && [" ", "Enter"].includes(event.key))) return;
      const step = event.shiftKey ? 1 : 0.1;
      const nth = this.flights[Number(event.key) - 1];
      const actions = {
        " ": () => this.play(!this.playing),
        ArrowLeft: () => this.go(this.time - step),
        ArrowRight: () => this.go(this.time + step),
        Home: () => this.go(this.begin),
        End: () => this.go(this.end),
        "+": () => this.scene.zoom(0.8),
        "-": () => this.scene.zoom(1.25),
        l: () => this.part(".loop").click(),
        c: () => this.nextCamera(),
      };
      const action = actions[event.key] || (nth && (() => this.showFlight(nth, !nth.shown)));
      if (!action) return;
      event.preventDefault();
      action();
    });
    this.root.addEventListener("pointerdown", () => { Player.chosen = this; });
  }

  nextCamera() {
    const select = this.part(".camera");
    select.selectedIndex = (select.selectedIndex + 1) % select.options.length;
    select.dispatchEvent(new Event("change"));
  }

  bindPlots() {
    const seek = (event) => {
      const plot = this.plots.plots.find((one) => one.over.contains(event.target));
      const t = plot && Plots.timeAt(plot, event.clientX);
      if (typeof t === "number") this.go(t);
    };
    this.part(".plots").addEventListener("pointerdown", seek);
    this.part(".plots").addEventListener("pointermove", (event) => { if (event.buttons) seek(event); });
    this.part(".plots").addEventListener("pointerup", () => this.plots.show(this.time));
    this.part(".plots").addEventListener("pointerleave", () => this.plots.show(this.time));
  }

  resize() {
    if (this.scene.resize()) this.plots.resize();
  }

  // ---- a flight that goes on ----

  follow(content) {
    this.isAtEnd = true;
    this.part(".state").textContent = "live";
    const update = () => {
      this.measureTime();
      if (this.isAtEnd) this.time = this.end;
      if (!this.measured && this.end > this.begin) { this.scene.measure(); this.measured = true; }
      this.draw();
      this.isWaiting = false;
    };
    listen(content.live, this.flights, () => {
      if (!this.isWaiting) { this.isWaiting = true; requestAnimationFrame(update); }
      if (!this.timer) this.timer = setTimeout(() => { this.timer = 0; this.drawLivePlots(content); }, PLOTS_EVERY);
    }, (reason) => {
      this.isLive = false;
      this.part(".state").textContent = reason || "the flight has ended";
      this.scene.measure();
      this.drawLivePlots(content);
      update();
    });
  }

  drawLivePlots(content) {
    const flight = this.flights[0], { time, position, reference, rotor_velocity: speeds } = flight.columns;
    const rows = [...Array(flight.rows).keys()];
    const curve = (find, part = "") => ({ flight: 0, part, values: rows.map(find) });
    const panels = [{ name: "Height (m)", least: 1e-6, curves: [curve((i) => position.values[3 * i + 2])] }];
    if (reference) {
      const away = (i) => Math.hypot(...[0, 1, 2].map((k) =>
        position.values[3 * i + k] - reference.values[reference.width * i + k]));
      panels.unshift({ name: "Tracking error (m)", least: 1e-6, curves: [curve(away)] });
    }
    const rotors = [...Array(flight.rotors).keys()];
    panels.push({ name: "Rotor speed (rad/s)", least: 1e-6, limits: flight.limit ? [flight.limit] : [],
      curves: rotors.map((k) => curve((i) => Math.abs(speeds.values[flight.rotors * i + k]), `rotor ${k + 1}`)) });
    this.plots.replace(panels.map((panel) => ({ ...panel, time: rows.map((i) => time.values[i]) })));
  }

  /** The player that keys act on: the last one touched, or the first one in view. */
  static active() {
    if (Player.chosen) return Player.chosen;
    const inView = (player) => {
      const { top, bottom } = player.root.getBoundingClientRect();
      return bottom > 0 && top < innerHeight;
    };
    return quadcore.players.find(inView);
  }
}

async function start(root) {
  const fold = root.closest("details:not([open])");
  if (fold) {  // a browser draws only some scenes at once
    fold.addEventListener("toggle", () => start(root), { once: true });
    return;
  }
  const content = JSON.parse(root.querySelector(".content").textContent);
  const numbers = readNumbers(await inflate(root.querySelector(".numbers").textContent.trim()));
  try {
    quadcore.players.push(new Player(root, fillNumbers(content, numbers)));
  } catch (error) {
    if (!/WebGL/.test(String(error))) throw error;
    root.querySelector(".view").textContent =
      "This browser does not offer WebGL, which the animation needs. Switch it on, or use another browser.";
  }
}

const quadcore = { players: [] };
window.quadcore = quadcore;
quadcore.ready = Promise.all([...document.querySelectorAll(".quadcore-player")].map(start));
if (location.hash === "#gif") quadcore.ready.then(() => {
  const written = document.createElement("pre");
  written.id = "gif";
  const bytes = Array.from(quadcore.players[0].makeGif(), (byte) => String.fromCharCode(byte));
  written.textContent = btoa(bytes.join(""));
  document.body.append(written);
});
