// SPDX-License-Identifier: Apache-2.0
// The panel in a real browser, in front of a service with simulated drives: programs, and strangers.
import { connect } from "node:net";
import { kSmall, memoryOf, openBrowser, sleep, until } from "./plant.mjs";
import { afterStalls, click, enabled, go, goConfirmed, inState, load, must, phase, picture, runTests, setFeedOverride, stateOf } from "./page_hand.mjs";
import { fetched, pictures, plant, playwright } from "./browser_case.mjs";

const kMaxPixels = 2;

// Where a pinhole camera sees a point of the workpiece frame, by its position, target and angle alone.
function pinholePixelOf(tip) {
  const { camera, controls, canvas, machine } = meridian.view;
  const m = machine.frames.workpiece.matrixWorld.elements;
  const point = [0, 1, 2].map((row) => m[row] * tip[0] + m[row + 4] * tip[1] + m[row + 8] * tip[2] + m[row + 12]);
  const minus = (a, b) => a.map((value, i) => value - b[i]), dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => a.map((value) => value / Math.hypot(...a));
  const eye = camera.position.toArray(), ahead = unit(minus(controls.target.toArray(), eye));
  const right = unit(cross(ahead, [0, 0, 1])), up = cross(right, ahead), ray = minus(point, eye);
  const scale = canvas.clientHeight / 2 / Math.tan((camera.fov * Math.PI) / 360) / dot(ray, ahead);
  return [canvas.clientWidth / 2 + scale * dot(ray, right), canvas.clientHeight / 2 - scale * dot(ray, up)];
}

async function pageShowsTheStatus({ page, errors }) {
  await until("a frame", () => page.evaluate(() => meridian.frame !== null));
  const seen = await page.evaluate(() => ({ tip: meridian.frame.tip, joints: meridian.frame.joints }));
  const drawn = await page.evaluate((joints) => {
    meridian.view.setJoints(joints);
    return { ...meridian.view.machine.frames.pose(), pixel: meridian.view.tipPixel() };
  }, seen.joints);
  must(Math.hypot(...drawn.tip.map((value, i) => value - seen.tip[i])) < 1e-6, "the picture's tip is not the status'");
  const computed = await page.evaluate(pinholePixelOf, seen.tip);
  must(Math.hypot(...drawn.pixel.map((value, i) => value - computed[i])) < kMaxPixels, `the tip is drawn at ${drawn.pixel}, computed at ${computed}`);
  must(errors.length === 0, `the page complains: ${errors}`);
}

const aPartRunsByClicksAlone = ({ page }) => afterStalls(page, () => onePartByClicks(page));

async function onePartByClicks(page) {
  await enabled(page);
  await load(page, plant.part());
  await inState(page, "Loaded");
  await click(page, "start");
  await sleep(300);
  must((await stateOf(page)) === "Loaded", "a single click on start moved the machine");
  must((await page.textContent("#confirm-message")).includes("approach"), "the approach is not declared");
  await picture(page, pictures, "panel-start");
  await page.click("#confirm-yes");
  await inState(page, "Running");
  await go(page, "hold", "Held");
  await goConfirmed(page, "resume", "Running");
  for (const percent of [30, 120, 20]) await setFeedOverride(page, percent);
  await sleep(1000);
  await theTextFollowsTheProgram(page);
  await picture(page, pictures, "panel-program");
  await page.click("#tab-machine");
  await picture(page, pictures, "panel-running");
  must((await page.evaluate(() => meridian.view.trail.count)) > 100, "there is no trail");
  await go(page, "abort", "Ready");
}

// The line that is marked in the text is that of the frame, and what is left of the time goes down with the plan.
async function theTextFollowsTheProgram(page) {
  const seen = () => page.evaluate(() => ({ marked: Number(document.querySelector("#program-text .now i")?.textContent), line: meridian.frame.line,
    toGo: meridian.program.toGo(meridian.frame), plan: meridian.frame.plan_time_s, whole: meridian.program.program.program_s, share: meridian.frame.feed_override }));
  await until("the text is at the line of the machine", async () => {
    const { marked, line } = await seen();
    return line > 0 && marked === line;
  }, 5000);
  const first = await seen();
  must(first.toGo > 0 && first.toGo * Math.min(first.share, 1) < first.whole + 1, `time to go is ${first.toGo} of ${first.whole} s`);
  const then = await until("the plan goes on", async () => {
    const now = await seen();
    return now.plan > first.plan + 0.5 && now;
  });
  const passed = then.plan - first.plan, gone = (first.toGo - then.toGo) * Math.min(first.share, 1);
  must(passed > 0.5 && Math.abs(gone - passed) < 0.1, `${passed} s of the plan passed, the time to go fell by ${gone} s`);
}

const part = () => {
  const file = join(plant.folder, "part.apt");
  plant.tool("surface", "--sample", "blossom", "-o", file);
  return file;
};
const kDoesNotFit = "PARTNO/TOO FAR\nUNITS/MM\nMULTAX/ON\nFEDRAT/900,MMPM\nGOTO/5000,0,50,0,0,1\nGOTO/5010,0,50,0,0,1\nBLESS/YOU\nGOTO/5010,0,50,0,0,0\nFINI\n";

async function aProgramIsCheckedAsAWhole({ page }) {
  await page.evaluate((text) => {
    const data = new DataTransfer();
    data.items.add(new File([text], "../../too far.apt"));
    window.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  }, kDoesNotFit);
  await phase(page, "refused");
  const findings = await page.$$eval("#program-findings li.refusal", (rows) => rows.map((row) => row.textContent));
  const lines = findings.map((text) => Number(/line (\d+)/.exec(text)?.[1]));
  for (const line of [5, 7, 8]) must(lines.includes(line), `no finding at line ${line}: ${findings.join("; ")}`);
  must((await page.textContent("#program-name")) === "too_far.apt", "the name leads elsewhere");
  must(await page.isDisabled("#program-load"), "a program that does not fit can be loaded");
  await picture(page, pictures, "panel-findings");
  const far = kDoesNotFit.replace("BLESS/YOU\n", "").replace("GOTO/5010,0,50,0,0,0\n", "");
  await page.setInputFiles("#program-file", { name: "far.apt", mimeType: "text/plain", buffer: Buffer.from(far) });
  await until("where it would fit", async () => (await page.textContent("#program-placing")).includes("It fits with the workpiece at"), 60000);
  await picture(page, pictures, "panel-placing");
}

const aProgramGoesOnAtALine = ({ page }) => afterStalls(page, () => oneProgramFromALine(page));

async function oneProgramFromALine(page) {
  await enabled(page);
  await page.click("#tab-program");
  await page.setInputFiles("#program-file", plant.part());
  // The program before this one may still be the one that is ready.
  const whole = await until("the time of the program", () => page.evaluate(() => {
    const { phase, program_s } = meridian.program.program;
    return phase === "ready" && !meridian.program.program.simulating && program_s;
  }), 60000);
  await page.fill("#program-line", "120");
  await page.click("#program-check:enabled");
  await until("the check from line 120", () => page.evaluate(() => meridian.program.program.first_line === 120), 10000);
  await phase(page, "ready", 60000);
  await until("the path of the rest", () => page.evaluate(() => meridian.program.path !== null));
  const { rest, first } = await page.evaluate(() => ({ rest: meridian.program.program.program_s, first: meridian.program.path.line.find((line) => line > 0) }));
  must(rest < 0.9 * whole && first >= 100, `from line ${first} it takes ${rest} of ${whole} s`);
  await page.click("#program-load:enabled");
  await inState(page, "Loaded");
  await go(page, "abort", "Ready");
  await phase(page, "ready");
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
  must((await exchange(`POST /program?key=&name=a HTTP/1.1\r\nHost: ${host}\r\nOrigin: http://${host}\r\nContent-Length: 4\r\n\r\nFINI`)).includes(" 403 "), "a program without a key is taken");
  must((await exchange(`POST /program?key=&name=a HTTP/1.1\r\nHost: ${host}\r\nOrigin: http://evil.example\r\nContent-Length: 4\r\n\r\nFINI`)).includes(" 403 "), "a program of another site is taken");
  must((await exchange(`GET /doctor HTTP/1.1\r\nHost: ${host}\r\nSec-Fetch-Site: cross-site\r\n\r\n`)).includes(" 403 "), "a page of another site makes the host work");
  must((await exchange(`GET /mesh?number=99 HTTP/1.1\r\nHost: ${host}\r\n\r\n`)).includes(" 404 "), "a mesh that is not there is served");
  must((await exchange(`GET /../../etc/passwd HTTP/1.1\r\nHost: ${host}\r\n\r\n`)).match(/ (404|400) /), "a path leads out");
}

// By keys alone, through TLS: the token, and the page behind it.
async function aBrowserElsewhereShowsTheToken(browser) {
  const elsewhere = await plant.startPanelElsewhere();
  const context = await browser.newContext({ viewport: kSmall, ignoreHTTPSErrors: true });
  const page = await context.newPage();
  // Asked while a page goes, the next one answers.
  const holds = (what, isTrue) => until(what, () => page.evaluate(isTrue).catch(() => false), 60000);
  await page.goto(elsewhere.secured);
  for (const [shown, isRight] of [["a wrong one", false], [elsewhere.token, true]]) {
    await holds("the cursor", () => document.activeElement.id === "token");
    await page.keyboard.type(shown);
    await page.keyboard.press("Enter");
    if (!isRight) await holds("the reason", () => document.querySelector('[role="alert"]').textContent.includes("not the token"));
  }
  await holds("a frame", () => globalThis.meridian?.frame != null);
  await context.close();
  elsewhere.panel.kill("SIGTERM");
  elsewhere.proxy.close();
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
  const before = await until("a status", () => plant.status().cycles_run);
  plant.panel.kill("SIGKILL");
  await sleep(1000);
  const after = await until("a status", () => [plant.status()].find(({ state }) => state));
  must(after.state === "Ready" && after.cycles_run > before, `the machine noticed: ${after.state}, cycles ${before} to ${after.cycles_run}`);
}

await runTests(plant, pictures, async (session, run) => {
  await plant.start();
  session.open = await openBrowser(playwright, plant);
  const { open } = session;
  await run("PageShowsTheStatus", pageShowsTheStatus, open);
  await run("AProgramIsCheckedAsAWhole", aProgramIsCheckedAsAWhole, open);
  await run("APartRunsByClicksAlone", aPartRunsByClicksAlone, open);
  await run("AProgramGoesOnAtALine", aProgramGoesOnAtALine, open);
  await run("ABrowserElsewhereShowsTheToken", aBrowserElsewhereShowsTheToken, open.browser);
  await run("StrangersReachNothing", strangersReachNothing);
  await run("JunkLeavesTheMemoryFlat", junkLeavesTheMemoryFlat, Number(process.env.MERIDIAN_PANEL_JUNK ?? 2000));
  await run("TheMachineDoesNotNoticeTheEndOfThePanel", theMachineDoesNotNoticeTheEndOfThePanel);
});
