// SPDX-License-Identifier: Apache-2.0
// Samples of the scope as an MCAP file: one message per cycle, JSON with its schema, for Foxglove and PlotJuggler.
import { McapWriter } from "@mcap/core";

const kTopic = "/meridian/scope";
const kNanoseconds = 1e9;

const schemaOf = (buffer) => {
  const numbers = (names) => ({ type: "object", properties: Object.fromEntries(names.map((name) => [name, { type: "number" }])) });
  return { type: "object", title: "meridian.Scope", properties: {
    cycle: { type: "integer" }, position: numbers(buffer.names), following: numbers(buffer.names),
    feed_mm_per_min: { type: "number" }, lateness_us: { type: "number" } } };
};

// What is not known has no key.
function messageOf(buffer, i) {
  const known = (pairs) => Object.fromEntries(pairs.filter(([, value]) => Number.isFinite(value)));
  const ofJoints = (columns) => known(buffer.names.map((name, k) => [name, columns[k][i]]));
  return { cycle: buffer.cycle[i], position: ofJoints(buffer.position), following: ofJoints(buffer.following),
    ...known([["feed_mm_per_min", buffer.feed[i]], ["lateness_us", buffer.lateness[i]]]) };
}

// The bytes of the file; `begin` and `end` in s. Times are those of the cycles since the service began.
export async function mcapOf(buffer, begin, end) {
  const parts = [];
  let length = 0;
  const writable = {
    position: () => BigInt(length),
    async write(bytes) {
      parts.push(bytes.slice());
      length += bytes.byteLength;
    },
  };
  const encoder = new TextEncoder();
  const writer = new McapWriter({ writable });
  await writer.start({ profile: "", library: "meridian" });
  const schemaId = await writer.registerSchema({ name: "meridian.Scope", encoding: "jsonschema", data: encoder.encode(JSON.stringify(schemaOf(buffer))) });
  const channelId = await writer.registerChannel({ schemaId, topic: kTopic, messageEncoding: "json", metadata: new Map() });
  let sequence = 0;
  for (const i of buffer.indices(begin, end)) {
    const logTime = BigInt(Math.round(buffer.time(i) * kNanoseconds));
    await writer.addMessage({ channelId, sequence: sequence++, logTime, publishTime: logTime, data: encoder.encode(JSON.stringify(messageOf(buffer, i))) });
  }
  await writer.end();
  return new Blob(parts, { type: "application/octet-stream" });
}
