// World, camera and everything that is drawn on the canvas.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Arrow, makeRing, Payload, ReferencePath, Trail } from "./markers.js";
import { makeVehicle } from "./vehicle.js";

const SMALLEST = 26;  // px, radius of a vehicle on the screen; smaller ones are enlarged
const WIND_SCALE = 0.12;  // reaches of the vehicle for 1 m/s
const THRUST_SCALE = 0.9;  // reaches for the rotor's usual thrust
const MOST_THRUST = 4;  // times the usual thrust
const ROTOR_SCALE = 0.05;  // share of the rotors' speed at which they are drawn
const THEMES = {
  light: { sky: "#eef2f6", ground: "#dfe4ea", line: "#9aa4b0", ink: "#303740" },
  dark: { sky: "#14181d", ground: "#20262d", line: "#4a5562", ink: "#d4dae2" },
};

export class Scene {
  constructor(holder, flights, content) {
    this.flights = flights;
    this.options = { trails: true, reference: true, thrust: true, names: true };
    this.camera = "follow";
    this.followed = flights[0];
    this.renderer = new THREE.WebGLRenderer({ antialias: true });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.canvas = this.renderer.domElement;
    holder.append(this.canvas);
    this.scene = new THREE.Scene();
    this.eye = new THREE.PerspectiveCamera(40, 1, 0.01, 1e5);
    this.eye.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.eye, this.canvas);
    this.controls.addEventListener("change", () => this.redraw());
    this.#light();
    this.hasGround = content.ground;
    this.obstacles = content.obstacles.map((obstacle) => this.#addObstacle(obstacle));
    this.actors = flights.map((flight, number) => this.#addActor(flight, number, content));
    this.setTheme(matchMedia("(prefers-color-scheme: dark)").matches);
    this.measure();
    this.setCamera(content.camera);
  }

  // ---- what is in the scene ----

  #light() {
    this.scene.add(new THREE.HemisphereLight("#ffffff", "#8090a0", 1.6));
    this.sun = new THREE.DirectionalLight("#ffffff", 2.2);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.scene.add(this.sun, this.sun.target);
    this.grid = new THREE.Group();
    this.scene.add(this.grid);
  }

  #addObstacle({ kind, size, pose, colour }) {
    const shapes = {
      box: () => new THREE.BoxGeometry(...size),
      cylinder: () => new THREE.CylinderGeometry(size[0], size[0], size[1], 48).rotateX(Math.PI / 2),
      sphere: () => new THREE.SphereGeometry(size[0], 40, 24),
    };
    const solid = new THREE.Mesh(shapes[kind](), new THREE.MeshStandardMaterial({
      color: new THREE.Color().setRGB(...colour.slice(0, 3), THREE.SRGBColorSpace), roughness: 0.9 }));
    solid.applyMatrix4(new THREE.Matrix4().set(...pose));
    solid.castShadow = solid.receiveShadow = true;
    this.scene.add(solid);
    return solid;
  }

  #addActor(flight, number, content) {
    const drawn = content.vehicles[flight.vehicle];
    const vehicle = makeVehicle(drawn, flight.colour, false);
    const ring = makeRing(vehicle.reach * (1.25 + 0.12 * number), flight.colour);
    vehicle.root.add(ring);
    const trail = new Trail(flight.colour, flight.dash.length > 0);
    const actor = { flight, vehicle, trail, wind: new Arrow("#7a8fa6"), thrusts: [], payloads: [] };
    this.scene.add(vehicle.root, trail.past, trail.whole, actor.wind.arrow);
    for (let i = 0; i < vehicle.rotors.length; ++i) {
      actor.thrusts.push(new Arrow(flight.colour));
      vehicle.root.add(actor.thrusts[i].arrow);
    }
    if (flight.columns.reference) {
      actor.ghost = makeVehicle(drawn, flight.colour, true);
      actor.path = new ReferencePath("#808890");
      this.scene.add(actor.ghost.root, actor.path.line);
    }
    for (let i = 0; i < flight.payloads.length; ++i) {
      actor.payloads.push(new Payload("#808890"));
      vehicle.root.add(actor.payloads[i].group);
    }
    const drop = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({
      color: flight.colour, transparent: true, opacity: 0.4 }));
    actor.drop = drop;
    this.scene.add(drop);
    return actor;
  }

  setTheme(isDark) {
    this.theme = THEMES[isDark ? "dark" : "light"];
    this.scene.background = new THREE.Color(this.theme.sky);
    if (this.box) this.#drawGrid();
  }

  /** Measure the flights: the box that the whole view shows, and the grid. */
  measure() {
    const box = new THREE.Box3();
    for (const flight of this.flights.filter((one) => one.shown)) {
      // With a reference, that alone sets the view: a diverged vehicle may leave it.
      const guide = flight.columns.reference;
      const isGuided = guide && guide.rows && Number.isFinite(guide.values[0]);
      const { values, width, rows } = isGuided ? guide : flight.columns.position;
      for (let i = 0; i < rows; ++i) {
        const point = new THREE.Vector3(...values.subarray(width * i, width * i + 3));
        if (Number.isFinite(point.lengthSq())) box.expandByPoint(point);
      }
    }
    if (box.isEmpty()) box.set(new THREE.Vector3(-1, -1, 0), new THREE.Vector3(1, 1, 1));
    this.box = box;
    this.#drawGrid();
  }

  #drawGrid() {
    const size = this.box.getSize(new THREE.Vector3()), middle = this.box.getCenter(new THREE.Vector3());
    const largest = Math.max(1, size.x, size.y, size.z);
    const power = 10 ** Math.floor(Math.log10(largest / 4));
    const square = power * [1, 2, 5].reduce((best, n) => (n * power <= largest / 4 ? n : best), 1);
    this.floor = this.hasGround ? 0 : square * Math.floor((this.box.min.z - 0.3 * square) / square);
    this.square = square;
    this.grid.clear();
    const half = square * Math.ceil(1.6 * largest / square);
    const center = [square * Math.round(middle.x / square), square * Math.round(middle.y / square)];
    const lines = new THREE.GridHelper(2 * half, Math.round(2 * half / square), this.theme.line, this.theme.line);
    lines.rotateX(Math.PI / 2);
    lines.position.set(center[0], center[1], this.floor + 1e-3 * square);
    lines.material.transparent = true;
    lines.material.opacity = 0.55;
    lines.material.depthWrite = false;
    lines.renderOrder = -1;
    const plane = new THREE.Mesh(
      new THREE.PlaneGeometry(200 * half, 200 * half),
      this.hasGround ? new THREE.MeshStandardMaterial({ color: this.theme.ground, roughness: 1 })
        : new THREE.ShadowMaterial({ opacity: 0.22 }));
    plane.position.set(center[0], center[1], this.floor);
    plane.receiveShadow = true;
    plane.material.depthWrite = false;  // else it would flicker through the grid
    plane.renderOrder = -2;
    const axes = new THREE.AxesHelper(square);
    axes.position.set(center[0] - half, center[1] - half, this.floor + 2e-3 * square);
    this.grid.add(plane, lines, axes);
    this.scene.fog = new THREE.Fog(this.theme.sky, 12 * half, 60 * half);
  }

  // ---- camera ----

  setCamera(name) {
    this.camera = name;
    const target = this.#target();
    const far = this.#reach() * 9;
    const directions = {
      follow: [-0.75, -0.85, 0.55], chase: [-1, 0, 0.35], top: [0, -1e-3, 1], side: [0, -1, 0.12],
      whole: [-0.75, -0.85, 0.55],
    };
    const sphere = this.box.getBoundingSphere(new THREE.Sphere());
    const distance = name === "whole" || name === "top" || name === "side"
      ? Math.max(2.9 * sphere.radius, far) : far;
    this.controls.target.copy(name === "follow" || name === "chase" ? target : sphere.center);
    this.last = this.controls.target.clone();
    this.eye.position.copy(this.controls.target).addScaledVector(
      new THREE.Vector3(...directions[name]).normalize(), distance);
    this.controls.update();
    this.redraw();
  }

  zoom(factor) {
    const offset = this.eye.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.eye.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.redraw();
  }

  #target() {
    const actor = this.actors.find((one) => one.flight === this.followed && one.now);
    const position = actor ? actor.now.position : null;
    return position && position.every(Number.isFinite)
      ? new THREE.Vector3(...position) : this.box.getCenter(new THREE.Vector3());
  }

  #reach() {
    const actor = this.actors.find((one) => one.flight === this.followed);
    return actor ? actor.vehicle.reach : 0.3;
  }

  #moveCamera() {
    if (this.camera !== "follow" && this.camera !== "chase") return;
    const target = this.#target();
    const actor = this.actors.find((one) => one.flight === this.followed);
    if (this.camera === "chase" && actor && actor.now) {
      const offset = this.eye.position.clone().sub(this.controls.target);
      const away = Math.hypot(offset.x, offset.y);
      const forward = new THREE.Vector3(1, 0, 0).applyQuaternion(new THREE.Quaternion(...actor.now.orientation));
      const heading = Math.atan2(forward.y, forward.x);
      this.eye.position.set(
        target.x - away * Math.cos(heading), target.y - away * Math.sin(heading), target.z + offset.z);
    } else {
      this.eye.position.add(target.clone().sub(this.controls.target));
    }
    this.controls.target.copy(target);
    this.controls.update();
  }

  // ---- drawing ----

  show(t) {
    this.actors.forEach((actor) => this.#place(actor, t));
    this.#moveCamera();
    this.redraw();
  }

  /** Draw with the next frame of the screen, once for all changes until then. */
  redraw() {
    this.frame ||= requestAnimationFrame(() => this.render());
  }

  #place(actor, t) {
    const { flight, vehicle, trail } = actor;
    const now = (actor.now = flight.rows ? flight.at(t) : null);
    const isShown = flight.shown && now !== null && now.position.every(Number.isFinite);
    for (const object of [vehicle.root, actor.drop]) object.visible = isShown;
    trail.whole.visible = isShown && this.options.trails;
    trail.past.visible = trail.whole.visible;
    actor.wind.arrow.visible = false;
    const isGuided = isShown && this.options.reference && now.reference && now.reference.every(Number.isFinite);
    if (actor.ghost) actor.ghost.root.visible = actor.path.line.visible = Boolean(isGuided);
    if (!isShown) return;
    vehicle.root.position.set(...now.position);
    vehicle.root.quaternion.set(...now.orientation);
    vehicle.rotors.forEach((rotor, i) => {
      if (now.angles) rotor.turning.quaternion.setFromAxisAngle(rotor.axis, ROTOR_SCALE * now.angles[i]);
    });
    if (trail.whole.visible) {
      trail.update(flight.columns.position);
      trail.showUntil(now.row);
    }
    if (isGuided) {
      actor.path.update(flight.columns.reference);
      actor.ghost.root.position.set(...now.reference.slice(0, 3));
      actor.ghost.root.rotation.set(0, 0, now.reference[3] || 0);
    }
    actor.payloads.forEach((payload, i) => payload.hang(now.payloads[i], vehicle.reach));
    vehicle.rotors.forEach((rotor, i) => {
      const ratio = Math.min(MOST_THRUST, (now.speeds[i] / flight.usualSpeed) ** 2);
      const up = rotor.axis.clone().applyQuaternion(rotor.place.quaternion);
      const size = this.options.thrust ? ratio * THRUST_SCALE * vehicle.reach : 0;
      actor.thrusts[i].point(rotor.place.position, up.multiplyScalar(size), 1);
    });
    actor.drop.geometry.setFromPoints([
      new THREE.Vector3(...now.position), new THREE.Vector3(now.position[0], now.position[1], this.floor)]);
  }

  /** Enlarge vehicles that would be too small to see, and draw now. */
  render() {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    const height = this.canvas.clientHeight || 1;
    this.eye.updateMatrixWorld();
    for (const { vehicle, ghost, now, wind } of this.actors) {
      if (!now || !vehicle.root.visible) continue;
      const away = this.eye.position.distanceTo(vehicle.root.position);
      const pixels = vehicle.reach * height / (2 * away * Math.tan(this.eye.fov * Math.PI / 360));
      const scale = Math.max(1, SMALLEST / pixels);
      vehicle.root.scale.setScalar(scale);
      if (ghost) ghost.root.scale.setScalar(scale);
      if (now.wind) wind.point(
        vehicle.root.position, new THREE.Vector3(...now.wind), WIND_SCALE * vehicle.reach * scale * 2);
    }
    const focus = this.controls.target, reach = this.eye.position.distanceTo(focus);
    this.sun.target.position.copy(focus);
    const height_above = Math.max(0, focus.z - this.floor);
    this.sun.position.copy(focus).add(new THREE.Vector3(0.12, 0.18, 1).multiplyScalar(reach + height_above + 5));
    Object.assign(this.sun.shadow.camera, {
      left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1,
      far: 2 * (reach + height_above) + 20 });
    this.sun.shadow.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.eye);
    if (this.onrender) this.onrender();
  }

  /** Fill the holder of the canvas; returns whether its size has changed. */
  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    const ratio = Math.min(2, devicePixelRatio), { x, y } = this.renderer.getSize(new THREE.Vector2());
    if (!width || !height) return false;
    if (x === width && y === height && ratio === this.renderer.getPixelRatio()) return false;
    this.setSize(width, height, ratio);
    this.render();  // now, since the canvas is empty
    return true;
  }

  setSize(width, height, ratio) {
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.eye.aspect = width / height;
    this.eye.updateProjectionMatrix();
  }

  /** Place on the canvas of a vehicle's name, in px, or null if it is not in view. */
  locate(actor) {
    if (!actor.now || !actor.vehicle.root.visible) return null;
    const point = actor.vehicle.root.position.clone().project(this.eye);
    if (point.z > 1 || Math.abs(point.x) > 1 || Math.abs(point.y) > 1) return null;
    return [(point.x + 1) / 2 * this.canvas.clientWidth, (1 - point.y) / 2 * this.canvas.clientHeight];
  }
}
