// SPDX-License-Identifier: Apache-2.0
// A whole part of a CAM system by clicks alone, with everything that an operator does on the way to its end.
import { existsSync } from "node:fs";
import { join, resolve } from "node:path";
import { openBrowser, sleep, until } from "./plant.mjs";
import { HostStalled, afterStalls, confirmed, drawAt, enabled, go, goConfirmed, inState, load, must, picture, runTests, setFeedOverride, stateOf } from "./page_hand.mjs";
import { pictures, plant, playwright } from "./browser_case.mjs";

const kTool = "45";  // the one that the file calls
const corpus = join(resolve(process.argv[6] ?? ""), "makino_ff_Plane_2.cldata");
if (!existsSync(corpus)) {
  console.log("SKIPPED: the corpus of CL files is not here");
  process.exit(77);
}
const kLimit_ms = 300000;

async function started(page) {
  await load(page, corpus);
  await inState(page, "Loaded");
  await goConfirmed(page, "start", "Running");
}

async function switched(page, name, isOn) {
  await page.click(`[data-switch="${name}"]:enabled`);
  await until(`${name} is ${isOn}`, () => page.evaluate(([key, wanted]) => meridian.frame[key] === wanted, [name, isOn]));
}

// Two blocks one by one, then on as before.
async function twoBlocksOneByOne(page) {
  await switched(page, "single_block", true);
  for (let i = 0; i < 2; ++i) {
    await inState(page, "Stepping", 60000);
    const block = await page.evaluate(() => meridian.frame.block);
    await confirmed(page, "resume");
    await until("the next block", () => page.evaluate((before) => meridian.frame.block > before, block), 60000);
  }
  await inState(page, "Stepping", 60000);
  await switched(page, "single_block", false);
  await goConfirmed(page, "resume", "Running");
}

async function aWholePartRunsByClicksAlone({ page }) {
  await drawAt(page, 0.1);
  await enabled(page);
  await started(page);
  await sleep(3000);
  await go(page, "hold", "Held");
  await goConfirmed(page, "resume", "Running");
  for (const percent of [30, 120]) {
    await setFeedOverride(page, percent);
    await sleep(2000);
  }
  await twoBlocksOneByOne(page);
  await setFeedOverride(page, 150);
  await until("the end of the part", async () => (await stateOf(page)) === "Ready", kLimit_ms);
  must((await page.evaluate(() => meridian.frame.alarm)) === null, "it ended with an alarm");
  return plant.status().cycles_run;
}

// A recording that a stalled host cut in two proves nothing: the plant begins anew.
async function inOnePiece(session) {
  for (let attempt = 1; ; ++attempt) {
    await plant.start({ tool: kTool });
    session.open = await openBrowser(playwright, plant);
    try {
      return await aWholePartRunsByClicksAlone(session.open);
    } catch (error) {
      if (!(error instanceof HostStalled) || attempt === 3) throw error;
      console.log(`  again, the host stalled: ${error.message}`);
      await session.open.browser.close();
      await session.open.server.close();
      await plant.end();
    }
  }
}

// Abort in the cut; the emergency stop input, reset, and the part once more.
const itBeginsAgainBehindAnEmergencyStop = ({ page }) => afterStalls(page, () => oneEmergencyStop(page));

async function oneEmergencyStop(page) {
  await enabled(page);
  await started(page);
  await go(page, "abort", "Ready");
  await started(page);
  await sleep(1000);
  plant.drives.stdin.write("emergency\n");
  await until("the fault", async () => (await stateOf(page)) === "Fault");
  must((await page.textContent("#alarm-text")).toLowerCase().includes("emergency"), "the alarm does not name the stop input");
  await drawAt(page, 1);
  await picture(page, pictures, "panel-alarm");
  await drawAt(page, 0.1);
  plant.drives.stdin.write("mend\n");
  await sleep(300);
  await go(page, "reset", "Off");
  await enabled(page);
  await started(page);
  await sleep(1000);
  await go(page, "abort", "Ready");
}

function theRecordingIsRight(end) {
  const machine = ["--machine", plant.machine], tools = ["--tools", plant.tools];
  const events = plant.recording.replace(/\.csv$/, ".events.csv"), simulated = join(plant.folder, "simulated.csv");
  const check = plant.tool("check", plant.recording, corpus, ...machine, ...tools, "--to-cycle", String(end), "--max-missing", "1000000");
  must(!check.startsWith("failed"), check);
  console.log(`  ${check.trim().split("\n").at(-1)}`);
  const simulation = plant.tool("simulate", corpus, ...machine, ...tools, "--events", events, "--start-from", plant.recording, "--record", simulated);
  must(!simulation.startsWith("failed"), simulation);
  const same = plant.tool("check", ...machine, "--same", plant.recording, simulated);
  must(!same.startsWith("failed"), same);
  console.log(`  ${same.trim().split("\n").at(-1)}`);
}

await runTests(plant, pictures, async (session, run) => {
  const end = await run("AWholePartRunsByClicksAlone", () => inOnePiece(session));
  await run("ItBeginsAgainBehindAnEmergencyStop", itBeginsAgainBehindAnEmergencyStop, session.open);
  await run("TheRecordingIsRight", async () => theRecordingIsRight(end));
});
