// Solid vehicles, made from the shapes of a URDF's visuals.

import * as THREE from "three";

const BLADES = 2;

export function makeVehicle(drawn, colour, ghost) {
  const root = new THREE.Group();
  const frame = new THREE.Group();
  root.add(frame);
  const rotors = [];
  let reach = 0.02;
  drawn.bodies.forEach((body, number) => {
    const placed = new THREE.Group();
    placed.applyMatrix4(new THREE.Matrix4().set(...body.pose));
    const turning = new THREE.Group();
    placed.add(turning);
    for (const shape of body.shapes) turning.add(makeSolid(shape, colour, ghost, number > 0));
    frame.add(placed);
    if (number > 0) {
      const disc = Math.max(0, ...body.shapes.map((shape) => shape.kind === "cylinder" ? shape.size[0] : 0));
      if (disc) turning.add(makeBlades(disc, body.axis, ghost ? null : colour));
      const place = placed.position;
      reach = Math.max(reach, Math.hypot(place.x, place.y, place.z) + 0.5 * disc);
      rotors.push({ turning, axis: new THREE.Vector3(...body.axis), place: placed });
    }
  });
  if (!rotors.length) reach = Math.max(reach, new THREE.Box3().setFromObject(frame).getSize(new THREE.Vector3()).length() / 2);
  return { root, frame, rotors, reach };
}

function makeSolid(shape, colour, ghost, isRotor) {
  const solid = new THREE.Mesh(makeGeometry(shape), makeMaterial(shape.colour, colour, ghost, isRotor));
  solid.applyMatrix4(new THREE.Matrix4().set(...shape.pose));
  if (shape.kind === "mesh") solid.scale.set(...shape.size);
  solid.castShadow = !ghost && !(isRotor && shape.kind === "cylinder");
  return solid;
}

function makeGeometry({ kind, size, vertices, faces }) {
  if (kind === "box") return new THREE.BoxGeometry(...size);
  if (kind === "sphere") return new THREE.SphereGeometry(size[0], 24, 16);
  if (kind === "cylinder") {
    const cylinder = new THREE.CylinderGeometry(size[0], size[0], size[1], 40);
    return cylinder.rotateX(Math.PI / 2);  // along z, as in a URDF
  }
  const mesh = new THREE.BufferGeometry();
  mesh.setAttribute("position", new THREE.BufferAttribute(vertices, 3));
  mesh.setIndex(Array.from(faces));
  const separate = mesh.toNonIndexed();
  separate.computeVertexNormals();
  return separate;
}

function makeMaterial([red, green, blue, opacity], colour, ghost, isRotor) {
  const own = new THREE.Color().setRGB(red, green, blue, THREE.SRGBColorSpace);
  if (!isRotor) own.lerp(new THREE.Color(colour), 0.55);  // frames have the colour of their flight
  const solid = ghost ? 0.18 : isRotor ? Math.min(opacity, 0.45) : opacity;
  return new THREE.MeshStandardMaterial({
    color: ghost ? new THREE.Color(colour) : own, roughness: 0.6, metalness: 0.05,
    transparent: solid < 1, opacity: solid, depthWrite: solid === 1, side: THREE.DoubleSide,
  });
}

/** A bar across a rotor's disc, so that one sees it turn. */
function makeBlades(radius, axis, colour) {
  const geometry = new THREE.BoxGeometry(BLADES * radius, 0.14 * radius, 0.04 * radius);
  const material = new THREE.MeshStandardMaterial({
    color: colour ?? "#888888", transparent: colour === null, opacity: colour === null ? 0.25 : 1,
    roughness: 0.6,
  });
  const blades = new THREE.Mesh(geometry, material);
  blades.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), new THREE.Vector3(...axis));
  blades.castShadow = colour !== null;
  return blades;
}
