// SPDX-License-Identifier: Apache-2.0
// read_test.mjs MERIDIAN SOURCE FETCHED FOLDER: simulates the sample part, converts its recording and holds every message
// of the MCAP file against the rows of the CSV file.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createReadStream, mkdirSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { load, McapFile } from "./mcap_file.mjs";

const [meridian, source, fetched, folder] = process.argv.slice(2);
const libraries = load(fetched);

const kMaxBytesAnHour = 400e6;
const kCycle_s = 1e-3;
mkdirSync(folder, { recursive: true });
const csv = join(folder, "run.csv"), mcap = join(folder, "run.mcap");
const machine = ["--machine", join(source, "deploy/machines/lai.toml"), "--tools", join(source, "deploy/tools.toml")];

execFileSync(meridian, ["simulate", join(source, "deploy/parts/blossom.apt"), ...machine, "--record", csv]);
const events = [["10", "feed_override", "0.5"], ["2000", "hold", "0"], ["2001", "resume", "0"]];
writeFileSync(join(folder, "run.events.csv"), "cycle,verb,argument,block,span\n" + events.map((row) => row.join(",") + "\n").join(""));
console.log(execFileSync(meridian, ["record", "--convert", csv, "--mcap", mcap, ...machine, "--tool", "1"]).toString().trim());

// The rows of the CSV file, one object each.
async function* rows() {
  let names;
  for await (const line of createInterface({ input: createReadStream(csv) })) {
    const fields = line.split(",");
    if (names === undefined) names = fields;
    else yield Object.fromEntries(fields.map((field, i) => [names[i], field]));
  }
}

const near = (is, wanted, tolerance, what) =>
  assert.ok(Math.abs(is - wanted) <= tolerance, `${what}: ${is} instead of ${wanted}`);
const ns = (time) => BigInt(time.sec) * 1_000_000_000n + BigInt(time.nanosec ?? time.nsec);

const file = new McapFile(mcap, libraries);
const reader = await file.indexed();
assert.equal(reader.header.profile, "ros2");
const decoders = new Map();
for (const [id, channel] of reader.channelsById) {
  assert.equal(channel.messageEncoding, "cdr");
  decoders.set(id, file.decoder(reader.schemasById.get(channel.schemaId)));
}
const topics = [...reader.channelsById.values()].map((channel) => channel.topic).sort();
assert.deepEqual(topics, ["/cycle", "/events", "/joint_states", "/limit_shares", "/machine", "/tf", "/tip", "/trail"]);
const types = Object.fromEntries([...reader.channelsById.values()].map(
  (channel) => [channel.topic, reader.schemasById.get(channel.schemaId).name]));
assert.equal(types["/joint_states"], "sensor_msgs/msg/JointState");
assert.equal(types["/tip"], "geometry_msgs/msg/PoseStamped");
assert.equal(types["/events"], "rcl_interfaces/msg/Log");

// The messages of one topic in the order of the file's time.
async function* messages(topic) {
  for await (const message of reader.readMessages({ topics: [topic] })) {
    yield { logTime: message.logTime, fields: decoders.get(message.channelId).readMessage(message.data) };
  }
}

const joints = ["b3", "b2", "b4", "theta1", "theta2"];
const names = { b3: "b3_mm", b2: "b2_mm", b4: "b4_mm", theta1: "theta1_rad", theta2: "theta2_rad" };
const in_ros_units = (name, value) => Number(value) * (names[name].endsWith("_mm") ? 1e-3 : 1);
const cycles = messages("/cycle");
const sent = new Map();  // what the topics of the screen are held against, by their time
let count = 0, before;
for await (const row of rows()) {
  const what = `row ${count}`;
  const { logTime, fields } = (await cycles.next()).value;
  assert.equal(logTime, BigInt(row.due_ns), what);
  assert.equal(ns(fields.header.stamp), BigInt(row.due_ns), what);
  assert.equal(fields.cycle, BigInt(row.cycle), what);
  assert.equal(fields.line, Number(row.line), what);
  assert.equal(fields.block, BigInt(row.sequence), what);
  assert.equal(fields.flags, Number(row.flags), what);
  near(fields.rate, Number(row.rate), 1e-7, `${what} rate`);
  near(fields.plan_time, Number(row.plan_time_s), 1e-6, `${what} plan time`);
  for (const joint of joints) {
    near(fields.position[joint], in_ros_units(joint, row[names[joint]]), 4.7e-10, `${what} ${joint}`);
    near(fields.velocity[joint], in_ros_units(joint, row[`${names[joint]}_per_s`]), 4.8e-7, `${what} ${joint} velocity`);
  }
  if (before !== undefined) {
    const way = Math.hypot(fields.tip.x - before.x, fields.tip.y - before.y, fields.tip.z - before.z);
    near(fields.feed, way / kCycle_s, 3e-6, `${what} feed`);
  }
  before = fields.tip;
  if (count === 0 || logTime % 40_000_000n === 0n) sent.set(logTime, fields);
  ++count;
}
assert.ok((await cycles.next()).done, "more messages than rows");

// Twenty-five a second, of rows that are there.
let screen = 0;
for await (const { logTime, fields } of messages("/joint_states")) {
  const row = sent.get(logTime);
  assert.deepEqual(fields.name, joints);
  assert.deepEqual([...fields.position], joints.map((joint) => row.position[joint]));
  ++screen;
}
assert.equal(screen, sent.size);
for await (const { logTime, fields } of messages("/tip")) {
  const row = sent.get(logTime), { x, y, z, w } = fields.pose.orientation;
  assert.deepEqual({ ...fields.pose.position }, { ...row.tip });
  const axis = { x: 2 * (x * z + y * w), y: 2 * (y * z - x * w), z: 1 - 2 * (x * x + y * y) };
  for (const along of ["x", "y", "z"]) near(axis[along], row.axis[along], 2e-6, `tool axis along ${along}`);
  --screen;
}
assert.equal(screen, 0);
assert.ok(count > 1000, `${count} rows`);

// The tree of frames leads from the workpiece to the tip.
const turned = ({ x, y, z, w }, v) => {
  const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]];
};
const inMachine = (frames, name, v) => {
  for (let frame = frames.get(name); frame !== undefined; frame = frames.get(frame.header.frame_id)) {
    const { rotation, translation: t } = frame.transform;
    const [x, y, z] = turned(rotation, v);
    v = [x + t.x, y + t.y, z + t.z];
  }
  return v;
};
let pictures = 0;
for await (const { logTime, fields } of messages("/tf")) {
  const frames = new Map(fields.transforms.map((frame) => [frame.child_frame_id, frame]));
  const { tip } = sent.get(logTime);
  const wanted = inMachine(frames, "workpiece", [tip.x, tip.y, tip.z]), is = inMachine(frames, "tool", [0, 0, 0]);
  for (const i of [0, 1, 2]) near(is[i], wanted[i], 1e-5, `tip in the machine, coordinate ${i}`);
  ++pictures;
}
assert.equal(pictures, sent.size);
for (const [topic, type, least] of [["/machine", 3, 6], ["/trail", 4, 7]]) {
  let markers = 0;
  for await (const { fields } of messages(topic)) {
    for (const marker of fields.markers) markers += marker.type === type && marker.frame_locked ? 1 : 0;
  }
  assert.ok(markers >= least, `${markers} markers in ${topic}`);
}

let most = 0, shares = 0;
for await (const { fields } of messages("/limit_shares")) {
  for (const joint of joints) most = Math.max(most, fields[joint].velocity, fields[joint].acceleration, fields[joint].jerk);
  ++shares;
}
assert.ok(most > 0.5 && most < 1.01, `the largest share of a limit is ${most}`);
assert.ok(Math.abs(shares - count / 40) <= 2, `${shares} messages of shares`);

const published = [];
for await (const { fields } of messages("/events")) if (fields.name === "operator") published.push(fields.msg);
assert.deepEqual(published, events.map(([, verb, argument]) => `${verb} ${argument}`));

// Once more without the summary; and what a process leaves that is killed.
const counted = new Map();
for (const record of file.records()) {
  if (record.type === "Message") counted.set(record.channelId, (counted.get(record.channelId) ?? 0n) + 1n);
}
assert.deepEqual(counted, reader.statistics.channelMessageCounts);
assert.ok(reader.chunkIndexes.length > 3, "several chunks");
const half = Number(reader.chunkIndexes[1].chunkStartOffset) + 1000;
let left = 0;
for (const record of file.records(half)) left += record.type === "Message" ? 1 : 0;
assert.ok(left > 100, `${left} messages in front of a cut`);
file.close();

const bytes_an_hour = (statSync(mcap).size / (count * kCycle_s)) * 3600;
const csv_an_hour = (statSync(csv).size / (count * kCycle_s)) * 3600;
console.log(`${count} rows, every one there; an hour ${(bytes_an_hour / 1e6).toFixed(0)} MB, CSV ${(csv_an_hour / 1e6).toFixed(0)} MB`);
assert.ok(bytes_an_hour < kMaxBytesAnHour, `an hour of it is ${(bytes_an_hour / 1e6).toFixed(0)} MB`);
