// SPDX-License-Identifier: Apache-2.0
// Where the tip went, coloured by how fast, with the tool axis as a fan. The oldest goes when it is long.
import { BufferAttribute, BufferGeometry, Color, Group, LineSegments } from "three";
import { bytesOf } from "./colour.js";
import { lineMaterial } from "./materials.js";
import { kStretch, mark, Polyline } from "./polyline.js";

// Halves are whole stretches, with a whole number of the fan's rays.
const kPoints = 32 * kStretch;
const kFanEvery = 8, kFanPoints = (2 * kPoints) / kFanEvery;
const kFanLength = 18;
const ramp = ["#4c6fff", "#22b8cf", "#37d67a", "#f5d90a"].map((text) => new Color(text));

export function rampColour(share, colour = new Color()) {
  const at = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
  const low = Math.min(Math.floor(at), ramp.length - 2);
  return colour.lerpColors(ramp[low], ramp[low + 1], at - low);
}

export class Trail {
  constructor() {
    this.root = new Group();
    this.line = new Polyline(kPoints);
    this.fanGeometry = new BufferGeometry();
    this.fanGeometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * kFanPoints), 3));
    this.fanGeometry.setAttribute("color", new BufferAttribute(new Uint8Array(3 * kFanPoints), 3, true));
    this.fan = new LineSegments(this.fanGeometry, lineMaterial(0.45));
    this.fan.frustumCulled = false;
    this.root.add(this.line.line, this.fan);
    this.lines = new Uint32Array(kPoints);
    this.clear();
  }

  setTheme(theme) {
    this.fan.material.uniforms.opacity.value = theme === "dark" ? 0.45 : 0.7;
  }

  get count() {
    return this.line.count;
  }

  clear() {
    this.line.clear();
    this.fanCount = 0;
    this.last = null;
    this.fanGeometry.setDrawRange(0, 0);
  }

  // `points`: rows x y z i j k line of the workpiece frame; `share` of the highest feed that is shown.
  add(points, share) {
    const tint = bytesOf(rampColour(share));
    for (const point of points) this.addPoint(point, tint);
    this.fanGeometry.setDrawRange(0, this.fanCount);
  }

  addPoint(point, tint) {
    const [x, y, z, i, j, k, line] = point;
    const { last, count } = this;
    if (last && Math.hypot(x - last[0], y - last[1], z - last[2]) < 1e-4) return;
    if (count === kPoints) this.halve();
    this.lines[this.count] = line;
    if (this.count % kFanEvery === 0) {
      this.addToFan([x, y, z], tint);
      this.addToFan([x + kFanLength * i, y + kFanLength * j, z + kFanLength * k], tint);
    }
    this.line.add([x, y, z], tint);
    this.last = point;
  }

  addToFan(point, tint) {
    const { position, color } = this.fanGeometry.attributes;
    for (const [attribute, values] of [[position, point], [color, tint]]) {
      attribute.array.set(values, 3 * this.fanCount);
      mark(attribute, 3 * this.fanCount, 3);
    }
    this.fanCount += 1;
  }

  // Full: the older half goes.
  halve() {
    this.line.drop(kPoints / 2);
    this.lines.copyWithin(0, kPoints / 2);
    this.fanCount -= kFanPoints / 2;
    for (const attribute of Object.values(this.fanGeometry.attributes)) {
      attribute.array.copyWithin(0, 3 * (kFanPoints / 2));
      mark(attribute, 0, 3 * this.fanCount);
    }
  }
}
