// SPDX-License-Identifier: Apache-2.0
// Many pages, one of them frozen, during a cut: the machine does not notice, and figures go to a real Prometheus.
// MERIDIAN_PANEL_MINUTES: how long (0.2).
import { connect } from "node:net";
import { execFileSync, spawn } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { cpuSecondsOf, memoryOf, Plant, sleep, until } from "./plant.mjs";
import { kOfStalls, must, runTests } from "./page_hand.mjs";
import { frame, upgrade } from "./raw_http.mjs";

const [bin, source] = process.argv.slice(2).map((path) => resolve(path));
const plant = new Plant(bin, source, "lai.toml");
const kMinutes = Number(process.env.MERIDIAN_PANEL_MINUTES ?? 0.2);
const kClients = 10, kMaxMemory_kib = 64 * 1024, kMaxShare = 0.25, kPong = 10;

// A page that reads all it gets; a frozen one reads nothing after the handshake.
function page(isFrozen) {
  const { host, hostname, port } = new URL(plant.url);
  const socket = connect(Number(port), hostname, () => socket.write(upgrade(host)));
  socket.bytes = 0;
  socket.on("error", () => {});
  // A browser answers pings by itself; who does not is hung up on after some.
  const pongs = isFrozen ? undefined : setInterval(() => socket.write(frame("", kPong)), 5000);
  socket.on("close", () => clearInterval(pongs));
  socket.on("data", (data) => {
    socket.bytes += data.length;
    if (isFrozen) socket.pause();
  });
  return socket;
}

// A host that stalls for longer than drives bridge ends a part in a fault, with pages or without.
function afterStall(station, stalls) {
  must(kOfStalls.includes(plant.status().alarm_name) && stalls <= 1 + kMinutes / 5, `the part was not cut to its end: ${station.text}`);
  plant.tool("ctl", "reset", "--domain", plant.domain);
  plant.tool("ctl", "enable", "--wait", "Ready", "--domain", plant.domain);
  console.log("  again, the host stalled");
}

// How often the cycle computed for at most each bound, s, since the service began.
async function computation() {
  const text = await (await fetch(new URL("/metrics", plant.url))).text();
  const rows = text.matchAll(/^meridian_latency_seconds_bucket\{[^}]*stage="cycle computation",le="([\d.e-]+)"\} (\d+)$/gm);
  return Array.from(rows, ([, bound, count]) => ({ bound: Number(bound), count: Number(count) }));
}

// The median, us, of what came between two of those.
function medianBetween(before, after) {
  const counts = after.map(({ count }, i) => count - before[i].count), half = counts.at(-1) / 2;
  const at = counts.findIndex((count) => count >= half);
  const [low, below] = at > 0 ? [after[at - 1].bound, counts[at - 1]] : [0, 0];
  return 1e6 * (low + ((after[at].bound - low) * (half - below)) / (counts[at] - below));
}

// While parts are cut, with pages or without.
async function cutsFor(minutes) {
  const before = await computation(), cut = cutsForever();
  await sleep(60000 * minutes);
  const median_us = medianBetween(before, await computation());
  return { median_us, parts: await cut.end() };
}

// A program that is long enough: the sample part again and again, by ctl and stream alone.
function cutsForever() {
  let isOver = false, count = 0, stalls = 0;
  const loop = (async () => {
    while (!isOver) {
      const station = plant.spawn("meridian", "stream", plant.part(), "--domain", plant.domain, "--wait-end");
      const isLoaded = await until("Loaded", () => (plant.status().state === "Loaded" ? "yes" : station.exitCode !== null && "no"), 30000);
      if (isLoaded === "yes") plant.tool("ctl", "start", "--domain", plant.domain);
      if ((await station.ended) === 0) ++count;
      else afterStall(station, ++stalls);
    }
  })();
  loop.catch(() => {});  // thrown where its end is waited for
  return { end: async () => ((isOver = true), await loop, count) };
}

async function manyPagesAndAFrozenOneDisturbNothing() {
  plant.tool("ctl", "enable", "--wait", "Ready", "--domain", plant.domain);
  const alone = await cutsFor(0.2);
  const pages = [page(true), ...Array.from({ length: kClients }, () => page(false))];
  await until("pages get frames", () => pages.slice(1).every((one) => one.bytes > 10000));
  const began = Date.now(), used = cpuSecondsOf(plant.panel.pid);
  const { median_us, parts } = await cutsFor(kMinutes);
  const share = (cpuSecondsOf(plant.panel.pid) - used) / ((Date.now() - began) / 1000), memory = memoryOf(plant.panel.pid);
  console.log(`  ${kMinutes} min, ${kClients} pages and a frozen one, ${parts} parts cut: panel ${(100 * share).toFixed(1)} % of a core, ${memory} KiB; a cycle computes for ${median_us.toFixed(2)} us, ${alone.median_us.toFixed(2)} without pages`);
  must(median_us <= 1.5 * alone.median_us + 1, "the cycle computes longer with pages");
  must(pages.slice(1).every((one) => !one.destroyed && one.bytes > 100000), "a page was left behind");
  must(memory < kMaxMemory_kib, `the panel takes ${memory} KiB`);
  must(share < kMaxShare, `the panel takes ${share} of a core`);
  pages.forEach((one) => one.destroy());
}

// The same operator events in a simulation without any panel: the same setpoints.
function theRecordingIsTheSameAsWithoutThem() {
  const machine = ["--machine", plant.machine], simulated = join(plant.folder, "simulated.csv");
  const events = plant.recording.replace(/\.csv$/, ".events.csv");
  const run = plant.tool("simulate", plant.part(), ...machine, "--tools", plant.tools, "--events", events, "--start-from", plant.recording, "--record", simulated);
  must(!run.startsWith("failed"), run);
  const same = plant.tool("check", ...machine, "--same", plant.recording, simulated);
  must(!same.startsWith("failed"), same);
  console.log(`  ${same.trim().split("\n").at(-1)}`);
}

async function aRealPrometheusScrapesTheFigures() {
  try {
    execFileSync("prometheus", ["--version"], { stdio: "ignore" });
  } catch {
    console.log("  skipped: prometheus is not here (Debian's prometheus)");
    return;
  }
  const file = join(plant.folder, "prometheus.yml"), port = 20000 + (process.pid % 20000);
  writeFileSync(file, `global: {scrape_interval: 1s}\nscrape_configs:\n  - job_name: meridian\n    static_configs: [{targets: ["${new URL(plant.url).host}"]}]\n`);
  const prometheus = spawn("prometheus", [`--config.file=${file}`, `--storage.tsdb.path=${join(plant.folder, "tsdb")}`, `--web.listen-address=127.0.0.1:${port}`], { stdio: "ignore" });
  const value = async (query) => {
    const answer = await fetch(`http://127.0.0.1:${port}/api/v1/query?query=${encodeURIComponent(query)}`).then((one) => one.json()).catch(() => null);
    const found = answer?.data?.result?.[0]?.value?.[1];
    return found === undefined ? undefined : Number(found);
  };
  try {
    await until("meridian_up in Prometheus", async () => (await value("meridian_up")) === 1, 60000);
    const before = await value("sum(meridian_latency_seconds_count)");
    must(before > 0, "no latency histogram");
    must((await value("histogram_quantile(0.99, sum by (le) (meridian_latency_seconds_bucket))")) > 0, "the buckets are no histogram");
  } finally {
    prometheus.kill("SIGTERM");
    await new Promise((done) => prometheus.on("exit", done));
  }
}

await runTests(plant, ".", async (session, run) => {
  await plant.start();
  await run("ARealPrometheusScrapesTheFigures", aRealPrometheusScrapesTheFigures);
  await run("ManyPagesAndAFrozenOneDisturbNothing", manyPagesAndAFrozenOneDisturbNothing);
  await run("TheRecordingIsTheSameAsWithoutThem", async () => theRecordingIsTheSameAsWithoutThem());
});
