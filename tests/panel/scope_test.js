// SPDX-License-Identifier: Apache-2.0
// The scope without a page: its states, what it keeps, and recordings that were cut.
import { readRecording } from "../../service/panel/page/src/scope/recording.js";
import { ScopeBuffer } from "../../service/panel/page/src/scope/scope_buffer.js";
import { ScopeState } from "../../service/panel/page/src/scope/scope_state.js";

const kJoints = [{ name: "x", rotary: false }], kLongestWindow_s = 20;
let failures = 0;
const check = (what, isTrue) => {
  if (isTrue) return;
  failures += 1;
  console.log(`FAILED: ${what}`);
};

function after(...events) {
  const state = new ScopeState();
  for (const event of events) state.take(event);
  return state.now;
}

for (const [wanted, ...events] of [
  ["running"], ["paused", "pause"], ["armed", "arm"], ["triggered", "arm", "fire"], ["running", "fire"], ["paused", "arm", "pause"],
  ["paused", "pause", "fire"], ["running", "arm", "fire", "go"], ["file", "arm", "open"], ["file", "open", "pause"], ["armed", "open", "arm"], ["running", "open", "go"],
]) {
  check(`[${events}] leads to ${wanted}, not to ${after(...events)}`, after(...events) === wanted);
}

// At any cycle time the longest window is there, a moment after the older half went too.
for (const cycle_s of [0.004, 0.001, 0.00025]) {
  const buffer = new ScopeBuffer(kJoints, cycle_s);
  let min_s = Infinity;
  for (let cycle = 0; cycle < 3 * buffer.capacity; ++cycle) {
    buffer.add(cycle, [0], [0], 0);
    if (cycle > buffer.capacity) min_s = Math.min(min_s, buffer.end - buffer.time(0));
  }
  check(`${min_s} s are kept at ${cycle_s} s`, min_s >= kLongestWindow_s && min_s < 3 * kLongestWindow_s);
}

const kHead = "cycle,x_mm,x_following_mm\n", kRows = "1,0.5,0\n2,0.6,0\n";
for (const [text, cut] of [[kRows, 0], [`${kRows}3,0.`, 1], [`${kRows}3,0.7,0\n4`, 1]]) {
  const read = readRecording(kHead + text, kJoints, 0.001);
  check(`${JSON.stringify(text)}: ${read.cut} rows are cut`, read.cut === cut && read.buffer.count >= 2);
}

process.exit(failures === 0 ? 0 : 1);
