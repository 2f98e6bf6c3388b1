// SPDX-License-Identifier: Apache-2.0
// What the scope does: it runs, waits for its trigger, stands where that fired or where it was paused, or shows a file.
const kNext = {
  running: { pause: "paused", arm: "armed", open: "file" },
  armed: { pause: "paused", arm: "armed", open: "file", fire: "triggered", go: "running" },
  triggered: { arm: "armed", open: "file", go: "running" },
  paused: { arm: "armed", open: "file", go: "running" },
  file: { arm: "armed", open: "file", go: "running" },
};

export class ScopeState {
  constructor() {
    this.now = "running";
  }

  // Whether `event` (pause, arm, open, fire, go) means anything in this state.
  take(event) {
    const next = kNext[this.now][event];
    if (next) this.now = next;
    return next !== undefined;
  }

  // Whether the newest sample is shown; else the picture stands still.
  get isFollowing() {
    return this.now === "running" || this.now === "armed";
  }
}
