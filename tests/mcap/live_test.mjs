// SPDX-License-Identifier: Apache-2.0
// live_test.mjs MERIDIAN MERIDIAND SOURCE FETCHED FOLDER: a service and simulated drives, which are killed in a motion. What
// `meridian record --mcap` writes beside its CSV file meanwhile, and the flight recorder's file as MCAP, are held row by row.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { createReadStream, mkdirSync, readdirSync, rmSync } from "node:fs";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { setTimeout as sleep } from "node:timers/promises";
import { load, McapFile } from "./mcap_file.mjs";

const [meridian, meridiand, source, fetched, folder] = process.argv.slice(2);
const libraries = load(fetched);

const joints = { b3: "b3_mm", b2: "b2_mm", b4: "b4_mm", theta1: "theta1_rad", theta2: "theta2_rad" };
const machine = join(source, "deploy/machines/lai.toml"), faults = join(folder, "faults");
const csv = join(folder, "wire.csv"), mcap = join(folder, "wire.mcap");
const domain = ["--domain", String(200 + (process.pid % 20))];
process.env.CYCLONEDDS_URI = `file://${join(source, "deploy/cyclonedds-loopback.xml")}`;
rmSync(folder, { recursive: true, force: true });
mkdirSync(faults, { recursive: true });

const children = [];
const start = (program, ...words) => {
  const child = spawn(program, [...words, ...domain], { stdio: "ignore" });
  child.over = new Promise((resolve) => child.on("exit", resolve));
  children.push(child);
  return child;
};
process.on("exit", () => children.forEach((child) => child.kill("SIGKILL")));
const ctl = (...words) => execFileSync(meridian, ["ctl", ...words, ...domain], { stdio: "pipe" }).toString();
async function eventually(what, attempt) {
  for (const end = Date.now() + 20_000; Date.now() < end; await sleep(100)) {
    try { if (attempt()) return; } catch { /* not yet */ }
  }
  assert.fail(`not in 20 s: ${what}`);
}
const status = () => {
  try { return execFileSync(meridian, ["status", ...domain], { stdio: "pipe" }).toString(); } catch { return ""; }
};
const stateIs = (state) => new RegExp(`^machine .*: ${state}`, "m").test(status());

// Every row is one message of /cycle with its numbers, and nothing else is in the file: each message of another topic is of
// the time of a row, or an event, and the file read record by record has as many as its summary says.
async function hold(rowsOf, path) {
  const file = new McapFile(path, libraries);
  const reader = await file.indexed();
  const topicOf = new Map(), decoders = new Map(), counted = new Map();
  for (const [id, channel] of reader.channelsById) {
    topicOf.set(id, channel.topic);
    decoders.set(id, file.decoder(reader.schemasById.get(channel.schemaId)));
    counted.set(channel.topic, 0);
  }
  const cycles = [], others = [];
  for await (const message of reader.readMessages()) {
    const topic = topicOf.get(message.channelId), fields = decoders.get(message.channelId).readMessage(message.data);
    counted.set(topic, counted.get(topic) + 1);
    (topic === "/cycle" ? cycles : others).push({ topic, logTime: message.logTime, fields });
  }
  const times = new Set();
  let names, count = 0;
  for await (const line of createInterface({ input: createReadStream(rowsOf) })) {
    const words = line.split(",");
    if (names === undefined) { names = words; continue; }
    const row = Object.fromEntries(words.map((word, i) => [names[i], word]));
    if (row.is_intact === "0") continue;
    const what = `row ${count} of ${rowsOf}`, { logTime, fields } = cycles[count++] ?? assert.fail(`${what} has no message`);
    times.add(logTime);
    assert.equal(logTime, BigInt(row.due_ns), what);
    assert.equal(fields.cycle, BigInt(row.cycle), what);
    assert.equal(fields.line, Number(row.line), what);
    assert.equal(fields.flags, Number(row.flags), what);
    for (const [joint, column] of Object.entries(joints)) {
      const unit = column.endsWith("_mm") ? 1e-3 : 1;
      assert.ok(Math.abs(fields.position[joint] - unit * row[column]) <= 4.7e-10, `${what}: ${joint}`);
      assert.ok(Math.abs(fields.velocity[joint] - unit * row[`${column}_per_s`]) <= 5e-7, `${what}: velocity of ${joint}`);
    }
  }
  assert.equal(cycles.length, count, `messages of /cycle in ${path}`);
  for (const { topic, logTime } of others) {
    assert.ok(topic === "/events" || times.has(logTime), `a message of ${topic} at ${logTime} has no row`);
  }
  const streamed = new Map([...counted.keys()].map((topic) => [topic, 0]));
  for (const record of file.records()) {
    if (record.type === "Message") streamed.set(topicOf.get(record.channelId), streamed.get(topicOf.get(record.channelId)) + 1);
  }
  assert.deepEqual(streamed, counted);
  assert.equal(reader.statistics.messageCount, BigInt(cycles.length + others.length));
  file.close();
  console.log(`${path}: ${[...counted].map(([topic, n]) => `${topic} ${n}`).join(", ")}; every row and message accounted for`);
  return { count, others };
}

const drives = start(meridian, "drives", "--machine", machine, "--quiet");
const service = start(meridiand, "--machine", machine, "--best-effort", "--faults", faults);
// A busy host may have stopped it meanwhile.
function isReady() {
  try {
    return ctl("enable", "--wait", "Ready", "--timeout", "3") !== "";
  } catch {
    ctl("reset", "--wait", "Off", "--timeout", "2");
    return false;
  }
}
await eventually("the machine is ready", isReady);
const recorder = start(meridian, "record", "--mcap", mcap, csv, "--timeout", "30");
await sleep(1500);
const moves = /^machine .*: (Stepping|Running|Approaching|Jogging)/m;
let doesMove = false;
for (let n = 0; n < 5 && !doesMove; ++n) {
  await eventually("the machine is ready again", isReady);
  start(meridian, "ctl", "move", "--joints", `b3=${n % 2 ? 0 : 300},b2=200,b4=150,theta1=30,theta2=20`, "--feed", "6000");
  for (let k = 0; k < 20 && !doesMove; ++k, await sleep(50)) doesMove = moves.test(status());
}
assert.ok(doesMove, "the machine does not move");
await sleep(700);
drives.kill("SIGKILL");
await eventually("the machine is in fault", () => stateIs("Fault"));
await eventually("the flight recorder has written", () => readdirSync(faults).some((name) => name.endsWith(".csv")));
await sleep(1000);
recorder.kill("SIGINT");
await recorder.over;
service.kill("SIGTERM");
await service.over;

const live = await hold(csv, mcap);
assert.ok(live.count > 1500, `${live.count} rows`);
assert.ok(live.others.some(({ topic, fields }) => topic === "/events" && /fault/i.test(fields.msg)), "the fault is an event");
const flight = join(faults, readdirSync(faults).find((name) => name.endsWith(".csv") && !name.includes("events")));
const converted = join(folder, "flight.mcap");
execFileSync(meridian, ["record", "--convert", flight, "--mcap", converted, "--machine", machine]);
const before = await hold(flight, converted);
assert.ok(before.count > 1000, `${before.count} rows in front of the fault`);
process.exit(0);
