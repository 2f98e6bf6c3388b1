// SPDX-License-Identifier: Apache-2.0
// What held the feed at a point of a path: a limit, or beside it a rest or a singularity. One number of each: those of limits
// (service/analysis/simulate/held_by.hpp), behind them the causes that say more than the limit does.
import { Color } from "three";

// Of limits by their number: nothing and the feed are calm, joints are not. Behind them velocity, acceleration and jerk of each.
const kCalm = ["#6b7a8c", "#37d67a", "#22b8cf"];
const kJoints = ["#ff5d5d", "#f5a524", "#c084fc", "#4c8dff", "#ff8ac2", "#b8e04a", "#ffd166", "#8ee3f5"];
const kOrders = [["#ffffff", 0], ["#ffffff", 0.45], ["#000000", 0.4]];

const kFirstCause = 256;
const kCauses = { 3: ["singularity", "#ffffff"], 4: ["rest: exact stop, begin or end", "#a0522d"], 7: ["rewind", "#d8d8d8"] };

export const heldAt = (limit, cause) => (cause in kCauses ? kFirstCause + cause : limit);

export function heldColour(held) {
  if (held >= kFirstCause) return kCauses[held - kFirstCause][1];
  if (held < 3) return kCalm[held];
  const [towards, share] = kOrders[(held - 3) % 3], colour = new Color(jointColour(Math.floor((held - 3) / 3)));
  return `#${colour.lerp(new Color(towards), share).getHexString()}`;
}

export const jointColour = (joint) => kJoints[joint % kJoints.length];

// `limits`: names by number.
export function heldName(held, limits) {
  if (held >= kFirstCause) return kCauses[held - kFirstCause][0];
  return held === 0 ? "nothing (rest, rapid)" : limits[held];
}

// Seconds by what held, longest first: [held, seconds].
export function timeByHeld(held, time) {
  const sums = new Map();
  for (let i = 1; i < held.length; ++i) sums.set(held[i], (sums.get(held[i]) ?? 0) + time[i] - time[i - 1]);
  return [...sums].sort((a, b) => b[1] - a[1]);
}
