// SPDX-License-Identifier: Apache-2.0
// A whole path at once, each stretch in the colour of what held it.
import { BufferAttribute, BufferGeometry, Color, Group, Line, LineBasicMaterial, LineSegments } from "three";

// Of limits by their number: nothing and the feed are calm, joints are not.
const kCalm = ["#6b7a8c", "#37d67a", "#22b8cf"];
const kJoints = ["#ff5d5d", "#f5a524", "#c084fc", "#4c8dff", "#ff8ac2", "#b8e04a", "#ffd166", "#8ee3f5"];

// Limits are numbered 0 none, 1 feed, 2 the machine's feed, then three orders of each joint.
export function limitColour(limit) {
  return limit < 3 ? kCalm[limit] : kJoints[Math.floor((limit - 3) / 3) % kJoints.length];
}

export class Path {
  constructor(columns) {
    const { tip, axis, limit } = columns;
    const count = limit.length;
    this.root = new Group();
    const geometry = new BufferGeometry();
    const colours = new Float32Array(3 * count);
    const colour = new Color();
    for (let i = 0; i < count; ++i) colour.set(limitColour(limit[i])).toArray(colours, 3 * i);
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(tip), 3));
    geometry.setAttribute("color", new BufferAttribute(colours, 3));
    this.line = new Line(geometry, new LineBasicMaterial({ vertexColors: true }));
    this.fan = this.fanOf(tip, axis, colours, count);
    this.root.add(this.line, this.fan);
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
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(tints), 3));
    const fan = new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.5 }));
    fan.visible = false;
    return fan;
  }
}
