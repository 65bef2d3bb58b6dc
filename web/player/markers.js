// What is drawn beside a vehicle: trail, reference, thrust, wind, payload, ring.

import * as THREE from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";

const finite = (values) => values.every(Number.isFinite);

/** A path whose past is strong and whose future is faint. */
export class Trail {
  constructor(colour, dashed) {
    this.past = new Line2(new LineGeometry(), new LineMaterial({
      color: colour, linewidth: 2.5, dashed, dashSize: 0.12, gapSize: 0.08 }));
    this.whole = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({
      color: colour, transparent: true, opacity: 0.3 }));
    this.dashed = dashed;
    this.past.frustumCulled = this.whole.frustumCulled = false;
    this.rows = 0;
  }

  /** Take the points of a column; true if the path changed. */
  update(column) {
    if (column.rows === this.rows) return;
    this.rows = column.rows;
    const points = column.values.slice(0, 3 * column.rows);
    for (let i = 0; i < points.length; ++i) if (!Number.isFinite(points[i])) points[i] = i > 2 ? points[i - 3] : 0;
    this.whole.geometry.dispose();
    this.whole.geometry = new THREE.BufferGeometry();
    this.whole.geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
    this.past.geometry.dispose();
    this.past.geometry = new LineGeometry();
    if (column.rows > 1) this.past.geometry.setPositions(points);
    if (this.dashed) this.past.computeLineDistances();
  }

  showUntil(row) {
    this.past.geometry.instanceCount = row;
    this.past.visible = row > 0;
  }
}

/** Dashed line along a reference. */
export class ReferencePath {
  constructor(ink) {
    this.line = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineDashedMaterial({
      color: ink, transparent: true, opacity: 0.75, dashSize: 0.15, gapSize: 0.1 }));
    this.line.frustumCulled = false;
    this.rows = 0;
  }

  update(column) {
    if (column.rows === this.rows) return;
    this.rows = column.rows;
    const points = [];
    for (let i = 0; i < column.rows; ++i) {
      const point = column.values.subarray(column.width * i, column.width * i + 3);
      if (finite([...point])) points.push(new THREE.Vector3(...point));
    }
    this.line.geometry.dispose();
    this.line.geometry = new THREE.BufferGeometry().setFromPoints(points);
    this.line.computeLineDistances();
  }
}

/** An arrow that can be moved. */
export class Arrow {
  constructor(colour) {
    this.arrow = new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 1, colour);
    this.arrow.visible = false;
  }

  point(from, vector, scale) {
    const size = vector.length() * scale;
    this.arrow.visible = Number.isFinite(size) && size > 1e-9;
    if (!this.arrow.visible) return;
    this.arrow.position.copy(from);
    this.arrow.setDirection(vector.clone().normalize());
    this.arrow.setLength(size, 0.25 * size, 0.12 * size);
  }
}

/** A ring around a vehicle; its radius tells coincident vehicles apart. */
export function makeRing(radius, colour) {
  const points = [];
  for (let i = 0; i <= 96; ++i) {
    const angle = i * Math.PI / 48;
    points.push(radius * Math.cos(angle), radius * Math.sin(angle), 0);
  }
  const geometry = new LineGeometry();
  geometry.setPositions(points);
  return new Line2(geometry, new LineMaterial({ color: colour, linewidth: 2 }));
}

/** A payload that hangs on the frame. */
export class Payload {
  constructor(ink) {
    this.group = new THREE.Group();
    this.ball = new THREE.Mesh(
      new THREE.SphereGeometry(1, 20, 14), new THREE.MeshStandardMaterial({ color: "#b07030" }));
    this.ball.castShadow = true;
    this.rope = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: ink }));
    this.group.add(this.ball, this.rope);
  }

  hang([mass, ...place], reach) {
    this.group.visible = mass > 0 && finite(place);
    if (!this.group.visible) return;
    this.ball.position.set(...place);
    this.ball.scale.setScalar(0.18 * reach);
    this.rope.geometry.setFromPoints([new THREE.Vector3(), this.ball.position]);
  }
}
