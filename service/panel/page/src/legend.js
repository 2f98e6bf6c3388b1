// SPDX-License-Identifier: Apache-2.0
// What held the feed, in words beside its colour, with its share of the time.
import { element } from "./dom.js";
import { heldColour, heldName } from "./held.js";
import { fixed } from "./units.js";

// `byHeld`: [held, seconds]; `limits`: names by number.
export function legendRows(byHeld, duration, limits) {
  return byHeld.map(([held, seconds]) => {
    const dot = element("i");
    dot.style.background = heldColour(held);
    return element("li", {}, dot, element("span", {}, heldName(held, limits)), element("b", {}, `${fixed((100 * seconds) / duration, 0)} %`));
  });
}
