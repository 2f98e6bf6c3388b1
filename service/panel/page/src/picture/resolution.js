// SPDX-License-Identifier: Apache-2.0
// Fewer pixels while the camera turns, where the host cannot draw all of them 30 times a second; all of them at rest.
const kSlow_ms = 31, kCoarser = 0.8, kMinShare = 0.45, kRest_ms = 180;

export class Resolution {
  // `isSlow`: the first turn begins with as few pixels as there may be. `ask`: asks for another picture.
  constructor(renderer, isSlow, ask) {
    this.renderer = renderer;
    this.ask = ask;
    this.full = Math.min(window.devicePixelRatio, 2);
    this.share = isSlow ? kMinShare : 1;
    this.isTurning = this.isFast = false;
    renderer.setPixelRatio(this.full);
  }

  // The camera moves.
  turn() {
    clearTimeout(this.rest);
    this.rest = setTimeout(() => this.stop(), kRest_ms);
    if (this.isTurning) return;
    this.isTurning = true;
    // The turn before may have been slow for another reason.
    if (this.isFast) this.share = Math.min(1, this.share / kCoarser);
    this.isFast = false;
    this.last = null;
    this.mean_ms = kSlow_ms / 2;
    if (this.share < 1) this.set(this.share);
  }

  stop() {
    this.isTurning = false;
    this.set(1);
  }

  // Before each picture, with the time of the browser's frame.
  picture(now_ms) {
    if (!this.isTurning) return;
    const took_ms = this.last === null ? this.mean_ms : Math.min(now_ms - this.last, 4 * kSlow_ms);
    this.last = now_ms;
    this.mean_ms += 0.2 * (took_ms - this.mean_ms);
    this.isFast = this.mean_ms < 0.7 * kSlow_ms;
    if (this.mean_ms < kSlow_ms || this.share <= kMinShare) return;
    this.share = Math.max(kCoarser * this.share, kMinShare);
    this.mean_ms = kSlow_ms / 2;
    this.set(this.share);
  }

  set(share) {
    this.renderer.setPixelRatio(this.full * share);
    this.ask();
  }
}
