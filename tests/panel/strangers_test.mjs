// SPDX-License-Identifier: Apache-2.0
// strangers_test.mjs BIN SOURCE: what no page of ours sends. MERIDIAN_PANEL_JUNK: how many junk requests and frames (2000).
import { resolve } from "node:path";
import { kOfStalls, must, runTests } from "./page_hand.mjs";
import { memoryOf, Plant, until } from "./plant.mjs";
import { exchange, frame, upgrade } from "./raw_http.mjs";

const [bin, source] = process.argv.slice(2).map((path) => resolve(path));
const plant = new Plant(bin, source, "lai.toml");
const kJunk = Number(process.env.MERIDIAN_PANEL_JUNK ?? 2000);
const kAtOnce = 16;
// Of a panel under a sanitizer, which keeps what was freed, more is said: MERIDIAN_PANEL_GROWTH, KiB.
const kMaxGrowth_kib = Number(process.env.MERIDIAN_PANEL_GROWTH ?? 4096);

async function strangersReachNothing() {
  const { host } = new URL(plant.url), ask = (bytes) => exchange(plant.url, bytes);
  must((await ask(upgrade(host))).includes(" 101 "), "the page itself is refused");
  must(!(await ask(upgrade(host, "http://evil.example"))).includes(" 101 "), "another site is let in");
  must(!(await ask(upgrade("evil.example"))).includes(" 101 "), "a foreign host is let in");
  must((await ask(`GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n`)).includes(" 403 "), "a foreign name is served");
  must((await ask(`POST /program?key=&name=a HTTP/1.1\r\nHost: ${host}\r\nOrigin: http://${host}\r\nContent-Length: 4\r\n\r\nFINI`)).includes(" 403 "), "a program without a key is taken");
  must((await ask(`POST /program?key=&name=a HTTP/1.1\r\nHost: ${host}\r\nOrigin: http://evil.example\r\nContent-Length: 4\r\n\r\nFINI`)).includes(" 403 "), "a program of another site is taken");
  must((await ask(`GET /doctor HTTP/1.1\r\nHost: ${host}\r\nSec-Fetch-Site: cross-site\r\n\r\n`)).includes(" 403 "), "a page of another site makes the host work");
  must((await ask(`GET /mesh?number=99 HTTP/1.1\r\nHost: ${host}\r\n\r\n`)).includes(" 404 "), "a mesh that is not there is served");
  must((await ask(`GET /../../etc/passwd HTTP/1.1\r\nHost: ${host}\r\n\r\n`)).match(/ (404|400) /), "a path leads out");
}

// The same numbers in every run (mulberry32).
function seeded(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

// Requests and frames of ever other kinds: cut off, too long, of the wrong type, nested, without sense.
function junkOf(host, random) {
  const below = (count) => Math.floor(random() * count), one = (list) => list[below(list.length)];
  const noise = (count) => String.fromCharCode(...Array.from({ length: below(count) }, () => below(256)));
  const value = () => one([0, -1, 1e308, 2 ** 53, 1.5, true, null, "", "-1", "18446744073709551616", [], {}, [[[]]], { seen: {} }, noise(20)]);
  const word = () => one(["start", "jog", "release", "take_over", "check", "load", "answer", "reset", "feed_override", "", noise(9)]);
  const message = () => JSON.stringify({ do: word(), id: one([1, value()]), line: value(), action: value(), done: value(), argument: value(), joint: value(), velocity: value(),
    distance: value(), tool: value(), seen: one([value(), { epoch: value(), sequence: value(), service: value() }]) });
  const path = () => one(["/", "/program", "/program/lines?first=1&count=4", "/program/path", "/metrics", "/doctor", "/mesh?number=0", "/login", `/${noise(30)}`, `/mesh?number=${value()}`,
    `/program/lines?first=${value()}&count=${value()}`]);
  const request = () => `${one(["GET", "POST", "PUT", noise(5)])} ${path()} HTTP/1.1\r\nHost: ${host}\r\n`;
  const kinds = [
    () => `GET /${"a".repeat(below(40000))} HTTP/1.1\r\nHost: ${host}\r\n\r\n`,
    () => noise(400),
    () => `${request()}\r\n`,
    () => request().slice(0, below(60)),
    () => `${request()}${`X-${noise(6)}: ${noise(50)}\r\n`.repeat(below(120))}\r\n`,
    () => `${request()}Content-Length: ${one([5, -1, "1e9", 99999999999, noise(4)])}\r\n\r\nhello`,
    () => `${request()}Transfer-Encoding: chunked\r\n\r\n${noise(4)}\r\n${noise(40)}`,
  ];
  const frames = [
    () => frame(message()),
    () => frame(message().slice(0, below(80))),
    () => frame(noise(2000), below(16)),
    () => frame("[".repeat(below(4000))),
    () => Buffer.from("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff", "latin1"),
    () => Buffer.from(noise(60), "latin1"),
  ];
  return () => {
    if (random() < 0.5) return Buffer.from(one(kinds)(), "latin1");
    return Buffer.concat([Buffer.from(upgrade(host)), ...Array.from({ length: 1 + below(4) }, () => one(frames)())]);
  };
}

async function junkLeavesTheMemoryFlat() {
  const next = junkOf(new URL(plant.url).host, seeded(1));
  const flood = async (many) => {
    for (let i = 0; i < many; i += kAtOnce) await Promise.all(Array.from({ length: kAtOnce }, () => exchange(plant.url, next(), 60)));
  };
  await flood(400);
  const before = memoryOf(plant.panel.pid);
  await flood(kJunk);
  const after = memoryOf(plant.panel.pid);
  console.log(`  ${kJunk} junk requests and frames: ${before} KiB before, ${after} KiB after`);
  must(after < before + kMaxGrowth_kib, "memory grew");
  must(plant.panel.exitCode === null && plant.panel.signalCode === null, `the panel ended: ${plant.panel.text.slice(-2000)}`);
  must((await fetch(plant.url)).ok, "the page is not served any more");
}

// Whom a sanitizer watches, it reports here: leaks, and what was reported on the way.
async function thePanelEndsInOrder() {
  plant.panel.kill("SIGTERM");
  must((await plant.panel.ended) === 0, `the panel ended with ${plant.panel.exitCode}: ${plant.panel.text.slice(-4000)}`);
  must(!/Sanitizer|runtime error/.test(plant.panel.text), plant.panel.text.slice(-4000));
  plant.panel = await plant.startPanel();
}

// In the middle of a cut. A host that stalls for longer than drives bridge ends a part too: again, with another panel.
async function theMachineDoesNotNoticeTheEndOfThePanel(attempt = 1) {
  plant.tool("ctl", "enable", "--wait", "Ready", "--domain", plant.domain);
  const station = plant.spawn("meridian", "stream", plant.part(), "--domain", plant.domain, "--wait-end");
  await until("Loaded", () => plant.status().state === "Loaded", 30000);
  plant.tool("ctl", "start", "--domain", plant.domain);
  await until("Running", () => plant.status().state === "Running" || station.exitCode !== null, 30000);
  plant.panel.kill("SIGKILL");
  if ((await station.ended) === 0) return must(plant.status().state === "Ready", "the machine is not ready behind the part");
  must(attempt < 4 && kOfStalls.includes(plant.status().alarm_name), `the machine noticed: ${station.text}`);
  console.log("  again, the host stalled");
  plant.tool("ctl", "reset", "--domain", plant.domain);
  plant.panel = await plant.startPanel();
  return theMachineDoesNotNoticeTheEndOfThePanel(attempt + 1);
}

await runTests(plant, ".", async (session, run) => {
  await plant.start();
  await run("StrangersReachNothing", strangersReachNothing);
  await run("JunkLeavesTheMemoryFlat", junkLeavesTheMemoryFlat);
  await run("ThePanelEndsInOrder", thePanelEndsInOrder);
  await run("TheMachineDoesNotNoticeTheEndOfThePanel", () => theMachineDoesNotNoticeTheEndOfThePanel());
});
