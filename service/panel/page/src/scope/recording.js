// SPDX-License-Identifier: Apache-2.0
// Recordings (docs/recordings.md) in the scope: columns are found by their names, others are passed over.
import { ScopeBuffer } from "./scope_buffer.js";

export const kMaxBytes = 96 << 20;

// The samples, and how many rows were cut off: the last of a service that ended in the middle of one. Throws Error with a sentence.
export function readRecording(text, joints, cycle_s) {
  const lines = text.split("\n");
  const names = lines[0].trim().split(",");
  const column = (name) => names.indexOf(name);
  const unit = (joint) => (joint.rotary ? "rad" : "mm");
  const position = joints.map((joint) => column(`${joint.name}_${unit(joint)}`));
  const feedback = joints.map((joint) => column(`${joint.name}_feedback_${unit(joint)}`));
  const following = joints.map((joint) => column(`${joint.name}_following_${unit(joint)}`));
  const cycle = column("cycle"), feed = column("feed_mm_per_min"), lateness_ns = column("lateness_ns");
  if (cycle < 0 || position.some((at) => at < 0)) {
    throw new Error(`this is no recording of this machine: it needs the columns cycle, ${joints.map((joint) => `${joint.name}_${unit(joint)}`).join(", ")}`);
  }
  const buffer = new ScopeBuffer(joints, cycle_s, Math.max(lines.length, 2));
  const number = (fields, at) => (at < 0 || fields[at] === undefined || fields[at] === "" ? NaN : Number(fields[at]));
  let cut = 0;
  for (const line of lines.slice(1)) {
    if (line === "") continue;
    const fields = line.split(",");
    if (fields.length < names.length || !Number.isFinite(number(fields, cycle))) {
      cut += 1;
      continue;
    }
    const q = position.map((at) => number(fields, at));
    const errors = joints.map((_, k) => (following[k] >= 0 ? number(fields, following[k]) : q[k] - number(fields, feedback[k])));
    buffer.add(number(fields, cycle), q, errors, number(fields, feed), number(fields, lateness_ns) / 1000);
  }
  if (buffer.count === 0) throw new Error("the recording has no rows");
  return { buffer, cut };
}
