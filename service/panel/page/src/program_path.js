// SPDX-License-Identifier: Apache-2.0
// The simulated path as the panel's process sends it: points of 20 numbers of 32 bits (service/panel/program/program_path.hpp).
import { heldAt, timeByHeld } from "./held.js";

const kWords = 20, kJoints = 14;

// The first index whose value is not below `value`; values do not fall.
function lowerBound(values, value) {
  let low = 0, high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

export class ProgramPath {
  constructor(buffer) {
    const reals = new Float32Array(buffer), counts = new Uint32Array(buffer);
    this.count = reals.length / kWords;
    const column = (from, at) => from.constructor.from({ length: this.count }, (_, i) => from[kWords * i + at]);
    this.time = column(reals, 0);
    this.planTime = column(reals, 1);
    this.feed = column(reals, 8);
    this.programmed = column(reals, 9);
    this.line = column(counts, 10);
    this.block = column(counts, 11);
    this.limit = column(counts, 12);
    this.held = column(counts, 13).map((cause, i) => heldAt(this.limit[i], cause));
    this.reals = reals;
    this.tip = new Float32Array(3 * this.count);
    this.axis = new Float32Array(3 * this.count);
    for (let i = 0; i < this.count; ++i) {
      this.tip.set(reals.subarray(kWords * i + 2, kWords * i + 5), 3 * i);
      this.axis.set(reals.subarray(kWords * i + 5, kWords * i + 8), 3 * i);
    }
  }

  get duration() {
    return this.count > 0 ? this.time[this.count - 1] : 0;
  }

  // The first point at or behind that time of the plan, and of that block or one behind it.
  find(planTime) {
    return lowerBound(this.planTime, planTime);
  }

  findBlock(block) {
    return lowerBound(this.block, block);
  }

  // How long the program still takes at 100 % when its plan has come to `planTime`.
  toGo(planTime) {
    const at = this.find(planTime);
    return at < this.count ? this.duration - this.time[at] : 0;
  }

  // How far the tip, mm, still goes from `tip` to the end of `line` when the plan has come to `planTime`.
  distanceToGo(planTime, line, tip) {
    const point = (i) => [0, 1, 2].map((k) => this.tip[3 * i + k]);
    let sum = 0, from = tip;
    for (let i = this.find(planTime); i < this.count && this.line[i] === line; ++i) {
      const to = point(i);
      sum += Math.hypot(...to.map((value, k) => value - from[k]));
      from = to;
    }
    return sum;
  }

  // Seconds by what held the feed, longest first: [held, seconds].
  byHeld() {
    return timeByHeld(this.held, this.time);
  }

  // Of point `i`, the first `count`; mm, rad.
  joints(i, count) {
    return this.reals.subarray(kWords * i + kJoints, kWords * i + kJoints + count);
  }
}
