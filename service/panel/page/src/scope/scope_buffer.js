// SPDX-License-Identifier: Apache-2.0
// Samples of the joints cycle by cycle, and what follows from them by finite differences. The oldest half goes where it is full.
// What is recorded alone is not on the wire.
import { shown } from "../units.js";

export const kQuantities = {
  position: { label: "position", perJoint: true, order: 0 },
  velocity: { label: "velocity", perJoint: true, order: 1 },
  acceleration: { label: "acceleration", perJoint: true, order: 2 },
  jerk: { label: "jerk", perJoint: true, order: 3 },
  following: { label: "following error", perJoint: true },
  feed: { label: "feed, mm/min", perJoint: false },
  lateness: { label: "lateness, \u00b5s", perJoint: false, isRecorded: true },
};

// What is kept at least, s: the longest window, and half of it after a trigger.
const kKept_s = 30;

export class ScopeBuffer {
  // `joints` of the scene; `cycle_s` is the period.
  constructor(joints, cycle_s, capacity = 2 * Math.ceil(kKept_s / cycle_s)) {
    Object.assign(this, { joints, cycle_s, capacity, count: 0, added: 0 });
    const column = () => new Float64Array(capacity);
    this.cycle = column();
    this.position = joints.map(column);
    this.following = joints.map(column);
    this.feed = column();
    this.lateness = column();
  }

  // One cycle; units mm, rad, mm/min, µs. What is not known is NaN.
  add(cycle, position, following, feed, lateness = NaN) {
    if (this.count > 0 && cycle <= this.cycle[this.count - 1]) this.count = 0; // another service
    if (this.count === this.capacity) this.halve();
    const i = this.count++;
    this.added += 1;
    this.cycle[i] = cycle;
    this.joints.forEach((_, k) => {
      this.position[k][i] = position[k];
      this.following[k][i] = following[k];
    });
    this.feed[i] = feed;
    this.lateness[i] = lateness;
  }

  halve() {
    const half = this.capacity >> 1;
    for (const column of [this.cycle, ...this.position, ...this.following, this.feed, this.lateness]) column.copyWithin(0, half);
    this.count -= half;
  }

  time(i) {
    return this.cycle[i] * this.cycle_s;
  }

  get end() {
    return this.count > 0 ? this.time(this.count - 1) : 0;
  }

  // The first sample at or after `seconds`.
  find(seconds) {
    let low = 0, high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.time(middle) < seconds - 1e-9) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  // Of joint `k` at sample `i`, as it is shown; null where it is not known: after a gap there is no difference.
  value(quantity, k, i) {
    const finite = (number) => (Number.isFinite(number) ? number : null);
    if (quantity === "feed" || quantity === "lateness") return finite(this[quantity][i]);
    const joint = this.joints[k];
    if (quantity === "following") return finite(shown(joint, this.following[k][i]));
    const { order } = kQuantities[quantity];
    if (i < order || this.cycle[i] - this.cycle[i - order] !== order) return null;
    const kWeights = [[1], [1, -1], [1, -2, 1], [1, -3, 3, -1]];
    const sum = kWeights[order].reduce((all, weight, back) => all + weight * this.position[k][i - back], 0);
    return finite(shown(joint, sum / this.cycle_s ** order));
  }

  // Rows for a plot from `begin` to `end` (s): [times, values of each joint of `chosen`]; a gap is a row of nothing.
  rows(quantity, chosen, begin, end) {
    const columns = kQuantities[quantity].perJoint ? chosen : [0];
    const out = [[], ...columns.map(() => [])];
    const last = Math.min(this.find(end) + 1, this.count);
    for (let i = this.find(begin); i < last; ++i) {
      if (out[0].length > 0 && this.cycle[i] - this.cycle[i - 1] > 1) {
        out[0].push((this.cycle[i - 1] + 1) * this.cycle_s);
        columns.forEach((_, c) => out[c + 1].push(null));
      }
      out[0].push(this.time(i));
      columns.forEach((k, c) => out[c + 1].push(this.value(quantity, k, i)));
    }
    return out;
  }

  // Of the samples from `begin` to `end` (s).
  *indices(begin, end) {
    const last = Math.min(this.find(end) + 1, this.count);
    for (let i = this.find(begin); i < last; ++i) yield i;
  }

  // Names of the joints with their units, as the columns of a recording have them.
  get names() {
    return this.joints.map((joint) => `${joint.name}_${joint.rotary ? "rad" : "mm"}`);
  }

  // CSV of the samples from `begin` to `end`: a header with units, a row per cycle.
  csv(begin, end) {
    const following = this.joints.map((joint) => `${joint.name}_following_${joint.rotary ? "rad" : "mm"}`);
    const text = (number) => (Number.isFinite(number) ? String(number) : "");
    const lines = [["cycle", "time_s", ...this.names, ...following, "feed_mm_per_min", "lateness_us"].join(",")];
    for (const i of this.indices(begin, end)) {
      lines.push([this.cycle[i], this.time(i).toFixed(6), ...this.position.map((column) => text(column[i])),
        ...this.following.map((column) => text(column[i])), text(this.feed[i]), text(this.lateness[i])].join(","));
    }
    return `${lines.join("\n")}\n`;
  }
}
