// SPDX-License-Identifier: Apache-2.0
// When a scope stops by itself: the state comes, an alarm comes, periods are lost, a value passes a level upwards.
export class Trigger {
  constructor() {
    this.disarm();
  }

  disarm() {
    this.kind = "none";
    this.at = null;
  }

  // `kind`: none, state, alarm, lost, level. `wanted`: the state, or the level with its quantity and joint.
  arm(kind, wanted) {
    Object.assign(this, { kind, wanted, at: null, before: null });
  }

  // What came from another service does not count.
  armAgain() {
    this.arm(this.kind, this.wanted);
  }

  get isArmed() {
    return this.kind !== "none" && this.at === null;
  }

  // Looks at a frame whose samples are in `buffer` from `first` on; sets `at` (s) where it fires.
  look(frame, buffer, first) {
    if (!this.isArmed) return;
    const before = this.before;
    this.before = { state: frame.state, alarm: frame.alarm?.name ?? null, lost: frame.periods_lost };
    if (this.kind === "level") return this.lookForLevel(buffer, first);
    if (!before) return;
    const fires = {
      state: frame.state === this.wanted && before.state !== this.wanted,
      alarm: this.before.alarm !== null && before.alarm !== this.before.alarm,
      lost: frame.periods_lost > before.lost,
    }[this.kind];
    if (fires) this.at = buffer.end;
  }

  lookForLevel(buffer, first) {
    const { quantity, joint, level } = this.wanted;
    for (let i = Math.max(first, 1); i < buffer.count; ++i) {
      const from = buffer.value(quantity, joint, i - 1), to = buffer.value(quantity, joint, i);
      if (from === null || to === null || !(from < level && to >= level)) continue;
      this.at = buffer.time(i);
      return;
    }
  }
}
