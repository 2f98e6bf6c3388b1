// SPDX-License-Identifier: Apache-2.0
// The panel in a real browser, in front of a service with simulated drives: programs, and a browser elsewhere.
import { kSmall, openBrowser, sleep, until } from "./plant.mjs";
import { afterStalls, click, enabled, go, goConfirmed, inState, load, must, phase, picture, runTests, setFeedOverride, stateOf } from "./page_hand.mjs";
import { pinholePixel } from "./pinhole.mjs";
import { pictures, plant, playwright } from "./browser_case.mjs";

const kMaxPixels = 2;

// The camera of the page, and where the tip is in the scene.
function seenBy(tip) {
  const { camera, controls, canvas, machine } = meridian.view, m = machine.frames.workpiece.matrixWorld.elements;
  return {
    point: [0, 1, 2].map((row) => m[row] * tip[0] + m[row + 4] * tip[1] + m[row + 8] * tip[2] + m[row + 12]),
    camera: { position: camera.position.toArray(), target: controls.target.toArray(), fov_deg: camera.fov, width: canvas.clientWidth, height: canvas.clientHeight },
  };
}

async function pageShowsTheStatus({ page, errors }) {
  await until("a frame", () => page.evaluate(() => meridian.frame !== null));
  const seen = await page.evaluate(() => ({ tip: meridian.frame.tip, joints: meridian.frame.joints }));
  const drawn = await page.evaluate((joints) => {
    meridian.view.setJoints(joints);
    return { ...meridian.view.machine.frames.pose(), pixel: meridian.view.tipPixel() };
  }, seen.joints);
  must(Math.hypot(...drawn.tip.map((value, i) => value - seen.tip[i])) < 1e-6, "the picture's tip is not the status'");
  const { camera, point } = await page.evaluate(seenBy, seen.tip), computed = pinholePixel(camera, point);
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

// Begun anew at once, as by systemd: the page follows, though the one before was heard a moment ago.
async function thePageFollowsAServiceThatBeginsAnew({ page }) {
  const before = await page.evaluate(() => meridian.frame.service);
  await plant.restartService();
  await until("a frame of the new service", () => page.evaluate((old) => meridian.frame !== null && meridian.frame.service !== old, before));
  await enabled(page);
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

await runTests(plant, pictures, async (session, run) => {
  await plant.start();
  session.open = await openBrowser(playwright, plant);
  const { open } = session;
  await run("PageShowsTheStatus", pageShowsTheStatus, open);
  await run("AProgramIsCheckedAsAWhole", aProgramIsCheckedAsAWhole, open);
  await run("APartRunsByClicksAlone", aPartRunsByClicksAlone, open);
  await run("AProgramGoesOnAtALine", aProgramGoesOnAtALine, open);
  await run("ThePageFollowsAServiceThatBeginsAnew", thePageFollowsAServiceThatBeginsAnew, open);
  await run("ABrowserElsewhereShowsTheToken", aBrowserElsewhereShowsTheToken, open.browser);
});
