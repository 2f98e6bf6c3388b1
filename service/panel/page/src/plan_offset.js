// SPDX-License-Identifier: Apache-2.0
// How far the plan of the machine is behind that of the simulated program, s: the machine approaches from where it stands, the
// simulation did from home. Every frame bounds it: the time of a block lies between that of its begin and its end.
export class PlanOffset {
  constructor(path) {
    this.path = path;
    this.low = -Infinity;
    this.high = Infinity;
  }

  // The next frame of the machine that runs the program of `path`.
  see({ plan_time_s, block, state }) {
    const { planTime, count } = this.path;
    if (count === 0) return;
    const isApproaching = state === "Approaching";
    const first = isApproaching ? 0 : Math.max(this.path.findBlock(block) - 1, 0);
    const last = isApproaching ? 0 : Math.min(this.path.findBlock(block + 1), count - 1);
    const low = plan_time_s - planTime[last], high = isApproaching ? Infinity : plan_time_s - planTime[first];
    this.low = Math.max(this.low, low);
    this.high = Math.min(this.high, high);
    if (this.low > this.high) [this.low, this.high] = [low, high]; // another plan
  }

  get value() {
    if (Number.isFinite(this.low) && Number.isFinite(this.high)) return (this.low + this.high) / 2;
    return Number.isFinite(this.low) ? this.low : 0;
  }
}
