// SPDX-License-Identifier: Apache-2.0
// A machine that is jogged from a browser rests wherever the hand is lost. MERIDIAN_PANEL_JOGS: how often each (1);
// MERIDIAN_PANEL_ENDS: these only, as in `kEnds`, with commas between.
import { familyOf, openBrowser, sleep, until } from "./plant.mjs";
import { afterStalls, drawAt, enabled, HostStalled, kOfStalls, must, picture, runTests, stateOf } from "./page_hand.mjs";
import { Fingers, middleOf } from "./finger.mjs";
import { pictures, plant, playwright } from "./browser_case.mjs";

const kTimes = Number(process.env.MERIDIAN_PANEL_JOGS ?? 1);
// Towards the middle of the travel: how often it may be is not bounded by its ends.
const buttonFrom = (at) => `.jog-row:first-child button:${at > 0 ? "first" : "last"}-of-type`;
const joint = () => plant.status().b3_mm;

// What presses: a mouse, or a finger.
async function handOn(page, isFinger) {
  if (isFinger) return Fingers.of(page);
  return { down: async ([x, y]) => (await page.mouse.move(x, y), page.mouse.down()), up: () => page.mouse.up() };
}

async function press(page, isFinger) {
  await enabled(page);
  if (await page.isHidden("#jog")) await page.click("#jog-toggle");
  await page.bringToFront();
  await drawAt(page, 0.2);
  const hand = await handOn(page, isFinger), at = await middleOf(page, buttonFrom(joint()));
  // A page that lags, as one drawn in software on a busy host does, lets go by itself: pressed again.
  for (let attempt = 1; ; ++attempt) {
    await hand.down(at);
    const from = joint();
    const isMoving = await until("the joint moves", () => Math.abs(joint() - from) > 0.02, 2000).then(() => true, () => false);
    if (isMoving && (await stateOf(page)) === "Jogging") return { hand, at };
    await hand.up();
    if ((await stateOf(page)) === "Fault") throw new HostStalled(await page.textContent("#alarm-text"));
    must(attempt < 8, "jog does not begin");
    await sleep(500);
  }
}

// Dead-man time, braking from 5 % of the speed, and what a busy host adds.
const kMaxRest_ms = 150 + 100 + 250;

// When the joint was commanded to move last, ms of the monotonic clock, by the service's own recording.
const lastMotion = () => Number(plant.newestRows().findLast((row) => Number(row.b3_mm_per_s) !== 0).due_ns) / 1e6;

// How long until it rests, ms; it stays where it came to rest.
async function restAfter(cut, end) {
  const begin = Number(process.hrtime.bigint()) / 1e6;
  await cut();
  let status;
  const isAtRest = await until("the machine rests", () => (status = plant.status()).state === "Ready", 3000).then(() => true, () => false);
  if (kOfStalls.includes(status.alarm_name)) throw new HostStalled(status.alarm_name);
  must(isAtRest, `${end}: still ${status.state}, ${status.alarm_name}`);
  const at = joint();
  await sleep(300);
  must(joint() === at, `${end}: it still moves`);
  const took = lastMotion() - begin;
  must(took < kMaxRest_ms, `${end}: at rest after ${took.toFixed(0)} ms`);
  return { took, at };
}

const hide = (page, isHidden) => page.evaluate((hidden) => {
  Object.defineProperty(document, "hidden", { configurable: true, get: () => hidden });
  Object.defineProperty(document, "visibilityState", { configurable: true, get: () => (hidden ? "hidden" : "visible") });
  document.dispatchEvent(new Event("visibilitychange"));
}, isHidden);
const signal = (family, name) => family.forEach((pid) => process.kill(pid, name));

async function comeBackAndReload({ page, pid }) {
  signal(familyOf(pid), "SIGCONT");
  await page.mouse.up();
  await page.reload();
}

async function openAnotherPanel({ page }) {
  await page.mouse.up();
  plant.panel = await plant.startPanel();
  await page.goto(plant.url);
}

// How the hand is lost, and how it comes back.
const kEnds = {
  "let go": { lose: ({ page }) => page.mouse.up() },
  "let go beside another button": { lose: async ({ page }) => (await page.mouse.down({ button: "right" }), page.mouse.up()), back: ({ page }) => page.mouse.up({ button: "right" }) },
  "finger lifted": { isFinger: true, lose: (_, finger) => finger.up() },
  "touch cancelled": { isFinger: true, lose: (_, finger) => finger.cancel() },
  "focus lost": { lose: ({ page }) => page.evaluate(() => window.dispatchEvent(new Event("blur"))) },
  "tab hidden": { lose: ({ page }) => hide(page, true), back: ({ page }) => hide(page, false) },
  "socket cut": { lose: ({ page }) => page.evaluate(() => meridian.link.socket.close()) },
  "browser stopped": { lose: ({ pid }) => signal(familyOf(pid), "SIGSTOP"), back: comeBackAndReload },
  "panel killed": { lose: () => plant.panel.kill("SIGKILL"), back: openAnotherPanel },
  "browser killed": { lose: ({ pid }) => signal(familyOf(pid).reverse(), "SIGKILL"), isGone: true },
};

async function jogEndsWhen(session, name) {
  const { lose, back, isGone, isFinger } = kEnds[name];
  const times = [];
  for (let i = 0; i < kTimes; ++i) {
    await afterStalls(session.open.page, async () => {
      const { hand } = await press(session.open.page, isFinger);
      const { took, at } = await restAfter(() => lose(session.open, hand), name);
      if (back) await back(session.open);
      if (isGone) session.open = await openBrowser(playwright, plant, { theme: "light" });
      else await session.open.page.mouse.up();
      await sleep(500);
      must(joint() === at, `${name}: the machine moved when the hand came back`);
      times.push(took);
    });
  }
  times.sort((a, b) => a - b);
  console.log(`  ${name}, ${times.length} times: at rest within ${times.at(-1).toFixed(0)} ms (median ${times[times.length >> 1].toFixed(0)})`);
}

// As a hand does that takes a small step more. A host that lags may let go once: not every time.
async function aFingerPressesAgainAtOnce({ page }) {
  await afterStalls(page, async () => {
    const { hand, at } = await press(page, true);
    for (let attempt = 0, isHeld = false; !isHeld; ++attempt) {
      must(attempt < 8, "every press after the first is let go at once");
      await hand.up();
      await sleep(50);
      await hand.down(at);
      await sleep(100);
      isHeld = await page.evaluate(() => meridian.jog.held !== null);
    }
    must(await page.evaluate(offerMenu), "the menu of a long press comes, or ends the jog");
    await hand.up();
    await until("no button is held", () => page.evaluate(() => meridian.jog.held === null));
  });
}

// What a browser does with a finger that rests; whether the jog, if any, goes on without a menu.
function offerMenu() {
  const { held } = meridian.jog, menu = new MouseEvent("contextmenu", { bubbles: true, cancelable: true });
  document.querySelector(".jog-row button").dispatchEvent(menu);
  return menu.defaultPrevented && meridian.jog.held === held;
}

await runTests(plant, pictures, async (session, run) => {
  await plant.start();
  session.open = await openBrowser(playwright, plant);
  await run("AFingerPressesAgainAtOnce", aFingerPressesAgainAtOnce, session.open);
  for (const name of process.env.MERIDIAN_PANEL_ENDS?.split(",") ?? Object.keys(kEnds)) {
    await run(`JogEndsWith: ${name}`, jogEndsWhen, session, name);
    if (name === "let go") await picture(session.open.page, pictures, "panel-jog");
  }
  await drawAt(session.open.page, 1);
  await picture(session.open.page, pictures, "panel-light");
});
