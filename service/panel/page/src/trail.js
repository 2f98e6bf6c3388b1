// SPDX-License-Identifier: Apache-2.0
// Where the tip went, coloured by how fast, with the tool axis as a fan. A ring of fixed size.
import { BufferAttribute, BufferGeometry, Color, Group, Line, LineBasicMaterial, LineSegments } from "three";

const kPoints = 120000;
const kFanEvery = 6;
const kFanLength = 18;
const ramp = ["#4c6fff", "#22b8cf", "#37d67a", "#f5d90a"].map((text) => new Color(text));

export function rampColour(share, colour = new Color()) {
  const at = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
  const low = Math.min(Math.floor(at), ramp.length - 2);
  return colour.lerpColors(ramp[low], ramp[low + 1], at - low);
}

function bufferOf(count) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * count), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(3 * count), 3));
  geometry.setDrawRange(0, 0);
  return geometry;
}

export class Trail {
  constructor() {
    this.root = new Group();
    this.geometry = bufferOf(kPoints);
    this.line = new Line(this.geometry, new LineBasicMaterial({ vertexColors: true }));
    this.fanGeometry = bufferOf(Math.ceil((2 * kPoints) / kFanEvery));
    this.fan = new LineSegments(this.fanGeometry, new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.45 }));
    for (const one of [this.line, this.fan]) {
      one.frustumCulled = false;
      this.root.add(one);
    }
    this.lines = new Uint32Array(kPoints);
    this.clear();
  }

  setTheme(theme) {
    this.fan.material.opacity = theme === "dark" ? 0.45 : 0.7;
  }

  clear() {
    this.count = 0;
    this.fanCount = 0;
    this.last = null;
    this.geometry.setDrawRange(0, 0);
    this.fanGeometry.setDrawRange(0, 0);
  }

  // `points`: rows x y z i j k line of the workpiece frame; `share` of the highest feed that is shown.
  add(points, share) {
    const colour = rampColour(share);
    for (const point of points) this.addPoint(point, colour);
    this.geometry.setDrawRange(0, this.count);
    this.fanGeometry.setDrawRange(0, this.fanCount);
    for (const geometry of [this.geometry, this.fanGeometry]) {
      geometry.attributes.position.needsUpdate = true;
      geometry.attributes.color.needsUpdate = true;
    }
  }

  addPoint(point, colour) {
    const [x, y, z, i, j, k, line] = point;
    const last = this.last;
    if (last && Math.hypot(x - last[0], y - last[1], z - last[2]) < 1e-4) return;
    if (this.count === kPoints) this.halve();
    const { position, color } = this.geometry.attributes;
    position.setXYZ(this.count, x, y, z);
    color.setXYZ(this.count, colour.r, colour.g, colour.b);
    this.lines[this.count] = line;
    if (this.count % kFanEvery === 0) {
      const fan = this.fanGeometry.attributes;
      fan.position.setXYZ(this.fanCount, x, y, z);
      fan.position.setXYZ(this.fanCount + 1, x + kFanLength * i, y + kFanLength * j, z + kFanLength * k);
      for (const at of [0, 1]) fan.color.setXYZ(this.fanCount + at, colour.r, colour.g, colour.b);
      this.fanCount += 2;
    }
    this.count += 1;
    this.last = point;
  }

  // Full: the older half goes.
  halve() {
    const half = kPoints / 2;
    for (const name of ["position", "color"]) this.geometry.attributes[name].array.copyWithin(0, 3 * half);
    this.lines.copyWithin(0, half);
    const fanHalf = Math.floor(this.fanCount / 4) * 2;
    for (const name of ["position", "color"]) this.fanGeometry.attributes[name].array.copyWithin(0, 3 * fanHalf);
    this.fanCount -= fanHalf;
    this.count = half;
  }
}
