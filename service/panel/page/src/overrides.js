// SPDX-License-Identifier: Apache-2.0
// The sliders of the overrides. They show what the machine says, except while a hand moves one and until its answer has come.
import { byId, setText } from "./dom.js";
import { fixed } from "./units.js";

const kAnswer_ms = 700;

class Slider {
  constructor(id, onValue) {
    this.input = byId(id);
    this.text = byId(`${id}-text`);
    this.ownUntil = 0; // performance.now()
    for (const kind of ["pointerdown", "touchstart"]) this.input.addEventListener(kind, () => (this.ownUntil = Infinity), { passive: true });
    // A browser may cancel the pointer of a finger that still moves the slider: its touch goes on.
    for (const kind of ["pointerup", "touchend", "touchcancel"]) window.addEventListener(kind, () => this.letGo());
    this.input.addEventListener("input", () => {
      this.ownUntil = Math.max(this.ownUntil, performance.now() + kAnswer_ms);
      setText(this.text, `${this.input.value} %`);
    });
    this.input.addEventListener("change", () => onValue(Number(this.input.value) / 100));
  }

  letGo() {
    if (this.ownUntil === Infinity) this.ownUntil = performance.now() + kAnswer_ms;
  }

  show(share) {
    if (performance.now() < this.ownUntil) return;
    this.input.value = String(Math.round(100 * share));
    setText(this.text, `${fixed(100 * share, 0)} %`);
  }
}

export class Overrides {
  // `onValue(verb, share)`: what a hand chose.
  constructor(onValue) {
    this.feed = new Slider("feed-slider", (share) => onValue("feed_override", share));
    this.rapid = new Slider("rapid-slider", (share) => onValue("rapid_override", share));
  }

  setMax(share) {
    this.feed.input.max = String(Math.round(100 * share));
  }

  setFrame(frame) {
    this.feed.show(frame.feed_override);
    this.rapid.show(frame.rapid_override);
  }

  enable(isEnabled) {
    for (const { input } of [this.feed, this.rapid]) input.disabled = !isEnabled;
  }
}
