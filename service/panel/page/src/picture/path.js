// SPDX-License-Identifier: Apache-2.0
// A whole path at once, each stretch in the colour of what held it.
import { Box3, BufferAttribute, BufferGeometry, Color, Group, LineSegments } from "three";
import { bytesOf } from "./colour.js";
import { heldColour } from "../held.js";
import { lineMaterial } from "./materials.js";
import { Polyline } from "./polyline.js";

function coloursOf(held) {
  const bytes = new Map();
  const colours = new Uint8Array(3 * held.length);
  for (let i = 0; i < held.length; ++i) {
    if (!bytes.has(held[i])) bytes.set(held[i], bytesOf(new Color(heldColour(held[i]))));
    colours.set(bytes.get(held[i]), 3 * i);
  }
  return colours;
}

export class Path {
  constructor(columns) {
    const { tip, axis, held } = columns;
    const count = held.length;
    this.root = new Group();
    const position = new Float32Array(tip), colours = coloursOf(held);
    this.bounds = new Box3().setFromArray(position);
    this.line = new Polyline(count);
    this.line.set(position, colours);
    this.fan = this.fanOf(tip, axis, colours, count);
    this.root.add(this.line.line, this.fan);
  }

  fanOf(tip, axis, colours, count) {
    const every = Math.max(1, Math.floor(count / 900));
    const kLength = 18;
    const points = [], tints = [];
    for (let i = 0; i < count; i += every) {
      const at = [0, 1, 2].map((k) => tip[3 * i + k]);
      points.push(...at, ...at.map((value, k) => value + kLength * axis[3 * i + k]));
      const tint = [0, 1, 2].map((k) => colours[3 * i + k]);
      tints.push(...tint, ...tint);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
    geometry.setAttribute("color", new BufferAttribute(new Uint8Array(tints), 3, true));
    const fan = new LineSegments(geometry, lineMaterial(0.5));
    fan.visible = false;
    return fan;
  }

  dispose() {
    this.root.removeFromParent();
    this.line.dispose();
    this.fan.geometry.dispose();
    this.fan.material.dispose();
  }
}
