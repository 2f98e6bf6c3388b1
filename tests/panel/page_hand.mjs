// SPDX-License-Identifier: Apache-2.0
// What an operator does on the page, and what he waits for.
import { join } from "node:path";
import { kPicture, kSmall, sleep, until } from "./plant.mjs";

export const must = (isTrue, words) => {
  if (!isTrue) throw new Error(words);
};

export const stateOf = (page) => page.textContent("#state");
// A host that stalls for longer than drives bridge ends a run in a fault, on any machine: that run counts for nothing.
export const kOfStalls = ["drive_fault", "feedback_lost", "setpoints_unheard", "following_error"];
export class HostStalled extends Error {}
export const inState = (page, state, ms) =>
  until(`state ${state}`, async () => {
    const now = await stateOf(page);
    if (now === "Fault" && !["Fault", "Off"].includes(state)) throw new HostStalled(await page.textContent("#alarm-text"));
    return now === state;
  }, ms);
const kAttempts = 5;

export async function afterStalls(page, test) {
  for (let attempt = 1; ; ++attempt) {
    try {
      return await test();
    } catch (error) {
      if (!(error instanceof HostStalled) || attempt === kAttempts) throw error;
      console.log(`  again, the host stalled: ${error.message}`);
      await page.keyboard.press("Escape");
      await click(page, "reset");
      await until("state Off", async () => (await stateOf(page)) === "Off");
    }
  }
}

export const click = (page, verb) => page.click(`[data-verb="${verb}"]:enabled`, { timeout: 15000 });
export async function confirmed(page, verb) {
  await click(page, verb);
  await page.click("#confirm-yes");
}
// Asks until it is so. A page that lags, drawn in software on a busy host, is refused as stale: looked again.
async function asked(page, ask, isSo) {
  for (let attempt = 1; ; ++attempt) {
    await ask();
    try {
      return await isSo();
    } catch (error) {
      const answer = await page.textContent("#reply");
      if (error instanceof HostStalled) throw error;
      if (!answer.includes("look again") || attempt === kAttempts) throw new Error(`${error.message}; the page says: ${answer}`);
    }
  }
}
export const goBy = (page, ask, state) => asked(page, ask, () => inState(page, state, 10000));
export const go = (page, verb, state) => goBy(page, () => click(page, verb), state);
export const goConfirmed = (page, verb, state) => goBy(page, () => confirmed(page, verb), state);
export async function enabled(page) {
  const isOff = await until("Off or Ready", async () => ({ Off: "off", Ready: "ready" })[await stateOf(page)]) === "off";
  if (isOff) await go(page, "enable", "Ready");
}
export function setFeedOverride(page, percent) {
  const isSet = async () => Math.abs((await page.evaluate(() => meridian.frame.feed_override)) - percent / 100) < 1e-9;
  return asked(page, () => page.fill("#feed-slider", String(percent)), () => until("the override", isSet, 10000));
}

// Drawn in software, the picture would take the time of what is tested where nobody looks at it.
export const drawAt = (page, ratio) =>
  page.evaluate((value) => (meridian.view.renderer.setPixelRatio(value), meridian.view.resize()), ratio);

// A picture of the page as a larger screen shows it, under that name in the folder.
export async function picture(page, folder, name) {
  await page.setViewportSize(kPicture);
  await sleep(500);
  await page.screenshot({ path: join(folder, `${name}.jpg`), type: "jpeg", quality: 80 });
  await page.setViewportSize(kSmall);
}

export const phase = (page, name, ms = 30000) =>
  until(`the program is ${name}`, () => page.evaluate((wanted) => meridian.program.program.phase === wanted && !meridian.program.program.simulating, name), ms);

// By the file button; what is dropped goes the same way.
export async function load(page, file) {
  await page.click("#tab-program");
  await page.setInputFiles("#program-file", file);
  await phase(page, "ready", 120000);
  await page.click("#program-load:enabled");
}

// The tests of one file, a line each; where one fails: a picture, and what the programs said.
export async function runTests(plant, pictures, tests) {
  const session = { open: null };
  try {
    await tests(session, async (name, test, ...words) => {
      const begin = Date.now();
      const value = await test(...words);
      console.log(`ok ${name} (${Date.now() - begin} ms)`);
      return value;
    });
  } catch (error) {
    console.log(`FAILED: ${error.stack}`);
    if (session.open) await picture(session.open.page, pictures, "failed").catch(() => {});
    console.log(plant.children.map((child) => child.text.slice(-600)).join("\n--\n"));
    process.exitCode = 1;
  } finally {
    await session.open?.browser.close().catch(() => {});
    await session.open?.server.close().catch(() => {});
    await plant.stop();
  }
  process.exit();
}
