// SPDX-License-Identifier: Apache-2.0
// One triangle of no size with each shader, while the page waits for its machine: shaders are compiled when they draw first.
import { BufferAttribute, BufferGeometry, Line, LineSegments, Matrix4, Mesh, Scene } from "three";
import { bodyMaterial, edgeMaterial, kMaxFrames, lineMaterial, plainMaterial } from "./materials.js";

function nothing(...attributes) {
  const geometry = new BufferGeometry();
  for (const name of ["position", ...attributes]) {
    const size = name === "frame" ? 1 : 3, kCorners = 6;
    const isByte = name === "frame" || name === "color";
    geometry.setAttribute(name, new BufferAttribute(isByte ? new Uint8Array(size * kCorners) : new Float32Array(size * kCorners), size, name === "color"));
  }
  return geometry;
}

export function warmUp(renderer, camera) {
  const frames = { value: Array.from({ length: kMaxFrames }, () => new Matrix4()) };
  const things = [
    new Mesh(nothing("normal", "color", "frame"), bodyMaterial(frames)), new LineSegments(nothing("frame"), edgeMaterial(frames, 0)),
    new LineSegments(nothing("color"), lineMaterial()), new Line(nothing("color"), lineMaterial()),
    new Mesh(nothing("normal", "uv"), plainMaterial(0)), new Mesh(nothing("normal", "uv"), plainMaterial(0, 0.5)),
  ];
  const scene = new Scene();
  for (const thing of things) {
    thing.frustumCulled = false;
    scene.add(thing);
  }
  renderer.render(scene, camera);
  for (const { geometry } of things) geometry.dispose();
}
