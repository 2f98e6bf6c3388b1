// SPDX-License-Identifier: Apache-2.0
// Values at the two cursors of the scope, and what lies between them.
import { element } from "../dom.js";
import { kQuantities } from "./scope_buffer.js";
import { fixed } from "../units.js";

const cells = (...texts) => texts.map((text) => element("span", {}, text));
const difference = (from, to, write) => (from === null || to === null ? "" : write(to - from));
const digits = (number) => (number === null ? "" : number.toPrecision(6));

// Cells of four columns: name, at cursor `a`, at `b`, difference; `b` null: there is none. `quantities`: of the plots; `chosen`:
// numbers of the joints.
export function readoutOf(buffer, quantities, chosen, [a, b]) {
  const second = (at) => (at === null ? "" : fixed(at, 4));
  const rows = [...cells("", "A", "B", "B \u2212 A"), ...cells("time, s", second(a), second(b), difference(a, b, second))];
  const valueAt = (at, quantity, k) => (at === null ? null : buffer.value(quantity, k, Math.min(buffer.find(at), buffer.count - 1)));
  for (const quantity of quantities) {
    const { perJoint, label } = kQuantities[quantity];
    for (const k of perJoint ? chosen : [0]) {
      const [from, to] = [valueAt(a, quantity, k), valueAt(b, quantity, k)];
      rows.push(...cells(perJoint ? `${buffer.joints[k].name} ${label}` : label, digits(from), digits(to), difference(from, to, digits)));
    }
  }
  return rows;
}
