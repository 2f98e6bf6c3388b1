// SPDX-License-Identifier: Apache-2.0
// browser_test.mjs BIN SOURCE FETCHED PICTURES: the panel in a real browser, in front of a service with simulated drives.
import { connect } from "node:net";
import { mkdirSync } from "node:fs";
import { join, resolve } from "node:path";
import { familyOf, findPlaywright, kLarge, kSmall, memoryOf, openBrowser, Plant, sleep, until } from "./plant.mjs";

const [bin, source, fetched, pictures] = process.argv.slice(2).map((path) => resolve(path));
const playwright = findPlaywright(fetched);
if (!playwright) {
  console.log("SKIPPED: chromium or playwright-core is not here (deploy/install_packages browser)");
  process.exit(77);
}
mkdirSync(pictures, { recursive: true });
const plant = new Plant(bin, source, "lai.toml");
const must = (isTrue, words) => {
  if (!isTrue) throw new Error(words);
};

const stateOf = (page) => page.textContent("#state");
// A host that stalls for longer than drives bridge ends a run in a fault, on any machine: that run counts for nothing.
class HostStalled extends Error {}
const inState = (page, state, ms) =>
  until(`state ${state}`, async () => {
    const now = await stateOf(page);
    if (now === "Fault" && state !== "Fault") throw new HostStalled(await page.textContent("#alarm-text"));
    return now === state;
  }, ms);
const kAttempts = 5;

async function afterStalls(page, test) {
  for (let attempt = 1; ; ++attempt) {
    try {
      return await test();
    } catch (error) {
      if (!(error instanceof HostStalled) || attempt === kAttempts) throw error;
      console.log(`  again, the host stalled: ${error.message}`);
      await page.keyboard.press("Escape");
      await click(page, "reset");
      await inState(page, "Off");
    }
  }
}
const click = (page, verb) => page.click(`[data-verb="${verb}"]:enabled`, { timeout: 15000 });
async function picture(page, name) {
  await page.setViewportSize(kLarge);
  await page.screenshot({ path: join(pictures, `${name}.png`) });
  await page.setViewportSize(kSmall);
}
const jointOf = (status) => status.b3_mm;
const firstJog = ".jog-row:first-child button:last-child";

async function pageShowsTheStatus({ page, errors }) {
  await until("a frame", () => page.evaluate(() => meridian.frame !== null));
  const seen = await page.evaluate(() => ({ tip: meridian.frame.tip, joints: meridian.frame.joints }));
  const drawn = await page.evaluate((joints) => {
    meridian.view.setJoints(joints);
    return { ...meridian.view.machine.frames.pose(), pixel: meridian.view.tipPixel() };
  }, seen.joints);
  must(Math.hypot(...drawn.tip.map((value, i) => value - seen.tip[i])) < 1e-6, "the picture's tip is not the status'");
  must(drawn.pixel.every((value) => value > 0), "the tip is not on the picture");
  must(errors.length === 0, `the page complains: ${errors}`);
}

const aPartRunsByClicksAlone = ({ page }) => afterStalls(page, () => onePartByClicks(page));

async function onePartByClicks(page) {
  await click(page, "enable");
  await inState(page, "Ready");
  const part = join(plant.folder, "part.apt");
  plant.tool("surface", "--sample", "blossom", "-o", part);
  const station = plant.spawn("meridian", "stream", part, "--domain", plant.domain, "--wait-end");
  await inState(page, "Loaded");
  await click(page, "start");
  await sleep(300);
  must((await stateOf(page)) === "Loaded", "a single click on start moved the machine");
  must((await page.textContent("#confirm-message")).includes("approach"), "the approach is not declared");
  await picture(page, "panel-start");
  await page.click("#confirm-yes");
  await inState(page, "Running");
  await click(page, "hold");
  await inState(page, "Held");
  await click(page, "resume");
  await page.click("#confirm-yes");
  await inState(page, "Running");
  for (const share of [30, 120]) {
    await page.fill("#feed-slider", String(share));
    await until("the override", async () => Math.abs((await page.evaluate(() => meridian.frame.feed_override)) - share / 100) < 1e-9);
  }
  await sleep(6000);
  await picture(page, "panel-running");
  must((await page.evaluate(() => meridian.view.trail.count)) > 100, "there is no trail");
  await click(page, "abort");
  await inState(page, "Ready");
  await station.ended;
}

async function restAfter(what, end) {
  const cut = Date.now();
  await what();
  await until("the machine rests", () => plant.status().state === "Ready", 3000);
  const took = Date.now() - cut;
  const at = jointOf(plant.status());
  await sleep(300);
  must(jointOf(plant.status()) === at, `${end}: it still moves`);
  console.log(`  ${end}: Ready within ${took} ms, polls of the status included`);
}

async function press(page) {
  if (await page.isHidden("#jog")) await page.click("#jog-toggle");
  await page.bringToFront();
  // Drawn small: what is tested is the hand, not the picture.
  await page.evaluate(() => (meridian.view.renderer.setPixelRatio(0.2), meridian.view.resize()));
  const box = await page.locator(firstJog).boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  // A page that lags, as one drawn in software on a busy host does, lets go by itself: pressed again.
  for (let attempt = 1; ; ++attempt) {
    await page.mouse.down();
    const from = jointOf(plant.status());
    const isMoving = await until("the joint moves", () => jointOf(plant.status()) > from + 0.02, 2000).then(() => true, () => false);
    if (isMoving && (await stateOf(page)) === "Jogging") return;
    await page.mouse.up();
    must(attempt < 8, "jog does not begin");
    await sleep(500);
  }
}

async function jogEndsWhereverTheHandIsLost(first) {
  let open = first;
  await inState(open.page, "Ready");
  await press(open.page);
  await restAfter(() => open.page.mouse.up(), "let go");
  await picture(open.page, "panel-jog");
  await press(open.page);
  await restAfter(() => open.page.evaluate(() => window.dispatchEvent(new Event("blur"))), "focus lost");
  await open.page.mouse.up();
  await press(open.page);
  await restAfter(() => open.page.evaluate(() => meridian.link.socket.close()), "socket cut");
  await open.page.mouse.up();
  await inState(open.page, "Ready");
  await press(open.page);
  const family = familyOf(open.pid);
  await restAfter(() => family.forEach((pid) => process.kill(pid, "SIGSTOP")), "browser stopped");
  family.forEach((pid) => process.kill(pid, "SIGCONT"));
  await open.page.mouse.up();
  await sleep(500);
  must(plant.status().state === "Ready", "a browser that came back moved the machine");
  await inState(open.page, "Ready");
  await press(open.page);
  await restAfter(() => familyOf(open.pid).reverse().forEach((pid) => process.kill(pid, "SIGKILL")), "browser killed");
  open = await openBrowser(playwright, plant, "light");
  await inState(open.page, "Ready");
  await sleep(500);
  must(plant.status().state === "Ready", "a reload moved the machine");
  return open;
}

// One connection with these bytes; what came back within a moment.
function exchange(bytes, ms = 400) {
  return new Promise((done) => {
    const { port, hostname } = new URL(plant.url);
    let text = "";
    const socket = connect(Number(port), hostname, () => socket.write(bytes));
    const end = () => (socket.destroy(), done(text));
    socket.on("data", (data) => (text += data.toString("latin1")));
    socket.on("error", end);
    socket.on("close", end);
    setTimeout(end, ms);
  });
}

const upgrade = (host, origin) =>
  `GET /live HTTP/1.1\r\nHost: ${host}\r\nOrigin: ${origin}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n` +
  "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";

async function strangersReachNothing() {
  const { host } = new URL(plant.url);
  must((await exchange(upgrade(host, `http://${host}`))).includes(" 101 "), "the page itself is refused");
  must(!(await exchange(upgrade(host, "http://evil.example"))).includes(" 101 "), "another site is let in");
  must(!(await exchange(upgrade("evil.example", "http://evil.example"))).includes(" 101 "), "a foreign host is let in");
  must((await exchange(`GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n`)).includes(" 403 "), "a foreign name is served");
  must((await exchange(`GET /../../etc/passwd HTTP/1.1\r\nHost: ${host}\r\n\r\n`)).match(/ (404|400) /), "a path leads out");
}

async function junkLeavesTheMemoryFlat(count) {
  const { host } = new URL(plant.url);
  const junk = [`GET /${"a".repeat(300)} HTTP/1.1\r\nHost: ${host}\r\n\r\n`, "\0\x01\x02 junk\r\n\r\n", `POST / HTTP/1.1\r\nHost: ${host}\r\nContent-Length: 5\r\n\r\nhello`,
    `${upgrade(host, `http://${host}`)}\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff`, `${upgrade(host, `http://${host}`)}\x81\x82\0\0\0\0{]`];
  const flood = async (many) => {
    for (let i = 0; i < many; i += 8) await Promise.all(Array.from({ length: 8 }, (_, k) => exchange(junk[(i + k) % junk.length], 60)));
  };
  await flood(200);
  const before = memoryOf(plant.panel.pid);
  await flood(count);
  const after = memoryOf(plant.panel.pid);
  console.log(`  ${count} junk requests: ${before} KiB before, ${after} KiB after`);
  must(after < before + 4096, "memory grew");
  must(plant.panel.exitCode === null, "the panel ended");
}

async function theMachineDoesNotNoticeTheEndOfThePanel() {
  const lost = plant.status().cycles_run;
  plant.panel.kill("SIGKILL");
  await sleep(1000);
  const { state, cycles_run } = plant.status();
  must(state === "Ready" && cycles_run > lost, "the machine noticed");
}

let open = null;
const run = async (name, test, ...words) => {
  const begin = Date.now();
  const value = await test(...words);
  console.log(`ok ${name} (${Date.now() - begin} ms)`);
  return value;
};
try {
  await plant.start();
  open = await openBrowser(playwright, plant);
  await run("PageShowsTheStatus", pageShowsTheStatus, open);
  await run("APartRunsByClicksAlone", aPartRunsByClicksAlone, open);
  open = await run("JogEndsWhereverTheHandIsLost", jogEndsWhereverTheHandIsLost, open);
  await picture(open.page, "panel-light");
  await run("StrangersReachNothing", strangersReachNothing);
  await run("JunkLeavesTheMemoryFlat", junkLeavesTheMemoryFlat, 2000);
  await run("TheMachineDoesNotNoticeTheEndOfThePanel", theMachineDoesNotNoticeTheEndOfThePanel);
} catch (error) {
  console.log(`FAILED: ${error.stack}`);
  if (open) await picture(open.page, "failed").catch(() => {});
  console.log(plant.children.map((child) => child.text.slice(-600)).join("\n--\n"));
  process.exitCode = 1;
} finally {
  await open?.browser.close().catch(() => {});
  await open?.server.close().catch(() => {});
  await plant.stop();
}
process.exit();
