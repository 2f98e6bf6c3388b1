// SPDX-License-Identifier: Apache-2.0
// The page where something is missing or somebody else is in charge: it says so, and the rest works on.
import { join } from "node:path";
import { kSmall, openBrowser, sleep, until } from "./plant.mjs";
import { drawAt, must, runTests, setFeedOverride } from "./page_hand.mjs";
import { Fingers, middleOf } from "./finger.mjs";
import { pictures, plant, playwright } from "./browser_case.mjs";

async function pageAt(browser, url, prepare = () => {}) {
  const page = await (await browser.newContext({ viewport: kSmall })).newPage();
  await page.addInitScript(prepare);
  await page.goto(url);
  await until("a frame", () => page.evaluate(() => globalThis.meridian?.frame != null));
  return page;
}

// Whether the page says nothing to its panel when that key is pressed.
function asksForNothingAt(key) {
  const { link } = meridian, said = [];
  link.say = (message) => said.push(message);
  document.body.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  delete link.say;
  return said.length === 0;
}

const visible = (page, selector) => page.locator(selector).filter({ visible: true }).count();

async function aPanelThatWatchesOffersNothing({ browser }) {
  const { panel, url } = await plant.spawnPanel("--watch");
  const page = await pageAt(browser, url);
  await until("the reason", async () => (await page.textContent("#who")) === "This panel only watches.");
  for (const selector of [".console button", ".console input", ".program-buttons button"]) {
    must((await visible(page, selector)) === 0, `${selector} is there, and dead`);
  }
  await page.click("#tab-program");
  must((await visible(page, ".program-buttons button")) === 0, "a program seems to be loadable");
  must((await page.textContent("#program-hint")).includes("only watches"), "nothing says why");
  must(await page.evaluate(asksForNothingAt, "Escape"), "Escape asks for a hold, in vain");
  await page.setInputFiles("#program-file", plant.part());
  await until("a refusal", async () => (await page.textContent("#reply")).includes("only watches"));
  await page.context().close();
  panel.kill("SIGTERM");
}

const withoutWebGl = () => {
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (kind, ...words) {
    return kind.startsWith("webgl") ? null : getContext.call(this, kind, ...words);
  };
};

const withBrokenWebGl = () => {
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (kind, ...words) {
    if (kind.startsWith("webgl")) throw new Error("the driver is gone");
    return getContext.call(this, kind, ...words);
  };
};

async function aPictureThatFailsLeavesTheButtons({ browser }) {
  const page = await pageAt(browser, plant.url, withBrokenWebGl);
  must((await page.textContent("#no-picture")).includes("the driver is gone"), "nothing says why");
  must((await page.textContent("#tip-x")) !== "\u2013" && (await visible(page, ".console button")) > 0, "the page went with its picture");
  await page.context().close();
}

// The page, and a run as one file.
async function withoutWebGlAllElseWorks({ browser }) {
  const page = await pageAt(browser, plant.url, withoutWebGl);
  await theReasonIsThere(page);
  must((await page.textContent("#tip-x")) !== "\u2013", "no numbers");
  await page.click('[data-switch="optional_stop"]:enabled');
  await until("a verb is obeyed", () => page.evaluate(() => meridian.frame.optional_stop));
  await page.setInputFiles("#program-file", plant.part());
  await until("the path's colours", async () => (await page.locator("#program-limits li").count()) > 0, 60000);
  await page.context().close();
  const file = join(plant.folder, "run.html");
  plant.tool("simulate", plant.part(), "--machine", plant.machine, "--tools", plant.tools, "--html", file);
  const viewer = await (await browser.newContext({ viewport: kSmall })).newPage();
  await viewer.addInitScript(withoutWebGl);
  await viewer.goto(`file://${file}`, { timeout: 90000 });
  await theReasonIsThere(viewer);
  must((await viewer.locator("#legend li").count()) > 0 && (await viewer.locator("#chart-feed canvas").count()) > 0, "the viewer shows no charts");
  await viewer.context().close();
}

async function theReasonIsThere(page) {
  await until("why there is no picture", async () => (await page.textContent("#no-picture")).includes("no WebGL"));
  must((await visible(page, "#no-picture")) === 1 && (await visible(page, ".tools button")) === 0, "buttons of a picture that is not there");
}

async function onlyOneProgramIsDropped({ page }) {
  await page.evaluate(() => {
    const data = new DataTransfer();
    for (const name of ["a.apt", "b.apt"]) data.items.add(new File(["FINI\n"], name));
    window.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  });
  must((await page.textContent("#reply")).startsWith("2 files at once"), "one of two is taken");
}

// The first answers are lost on the way.
async function aPathThatDoesNotComeIsAskedForAgain({ page }) {
  let lost = 0;
  await page.route("**/program/path*", (route) => (lost++ < 2 ? (lost === 1 ? route.abort() : route.fulfill({ status: 503 })) : route.continue()));
  const before = await page.evaluate(() => meridian.program.shownPath ?? 0);
  await page.setInputFiles("#program-file", plant.part());
  await until("the path", () => page.evaluate((old) => meridian.program.shownPath > old && meridian.program.path !== null, before), 60000);
  must(lost >= 3, "nothing was lost");
  await page.unroute("**/program/path*");
}

const kSmallPart = "PARTNO/SMALL\nUNITS/MM\nMULTAX/ON\nFEDRAT/300,MMPM\nGOTO/0,0,20,0,0,1\nGOTO/4,0,20,0,0,1\nGOTO/4,3,20,0,0,1\nFINI\n";

// Of a part of some millimetres, as of any other.
async function aSmallPartFillsItsView({ page }) {
  await page.setInputFiles("#program-file", { name: "small.apt", mimeType: "text/plain", buffer: Buffer.from(kSmallPart) });
  await until("its path", () => page.evaluate(() => meridian.program.program.name === "small.apt" && meridian.program.path !== null), 30000);
  await page.click("#tab-machine");
  await page.click('[data-view="part"]');
  const share = await page.evaluate(() => {
    const { view } = meridian, { min, max } = view.path.bounds, { matrixWorld } = view.machine.frames.workpiece;
    const seen = [min, max].map((corner) => corner.clone().applyMatrix4(matrixWorld).project(view.camera));
    return Math.hypot((seen[0].x - seen[1].x) / 2, (seen[0].y - seen[1].y) / 2);
  });
  must(share > 0.15, `a part of 5 mm has ${(100 * share).toFixed(1)} % of the picture`);
  await page.click('[data-view="iso"]');
}

async function theThemeIsTheSystemsUntilSomebodyChooses({ browser }) {
  const page = await pageAt(browser, plant.url);
  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  for (const wanted of ["light", "dark", "light"]) {
    await page.emulateMedia({ colorScheme: wanted });
    await until(`the theme is ${wanted}`, async () => (await theme()) === wanted, 3000);
  }
  await page.click("#theme");
  await page.emulateMedia({ colorScheme: "dark" });
  await page.emulateMedia({ colorScheme: "light" });
  await page.reload();
  must((await theme()) === "dark", "what was chosen is not kept");
  await page.context().close();
}

// Midnight is no 24 o'clock, and no 12.
async function timesHave24Hours({ browser }) {
  const page = await (await browser.newContext({ viewport: kSmall, locale: "en-US" })).newPage();
  await page.goto(plant.url);
  await until("the page", () => page.evaluate(() => globalThis.meridian?.display !== undefined));
  const [time] = await page.evaluate(() => {
    meridian.display.setNews([{ time_ms: new Date().setHours(0, 5, 7, 0), severity: 0, source: "machine", text: "" }]);
    return [document.querySelector("#news time").textContent];
  });
  must(time === "00:05:07", `five past midnight is shown as ${time}`);
  await page.context().close();
}

// A stretch is shown alone until the scope goes on; what stands still stays when the service begins anew.
async function theScopeZoomsAndBeginsAnew({ page }) {
  await page.click("#tab-scope");
  await until("samples", () => page.evaluate(() => meridian.scope.live.count > 200), 20000);
  const box = await page.locator("#scope-plot-1 .u-over").boundingBox(), y = box.y + box.height / 2;
  await page.mouse.move(box.x + 0.5 * box.width, y);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.75 * box.width, y, { steps: 4 });
  await page.mouse.up();
  const seen = () => page.evaluate(() => ({ state: meridian.scope.state.now, width: meridian.scope.range()[1] - meridian.scope.range()[0], window: meridian.scope.window }));
  const zoomed = await seen();
  must(zoomed.state === "paused" && zoomed.width < 0.3 * zoomed.window, `${zoomed.state}, ${zoomed.width} s are shown`);
  const { isNew, isKept } = await page.evaluate(() => {
    const { scope, frame } = meridian, { live } = scope;
    scope.setFrame({ ...frame, service: "another" });
    return { isNew: scope.live !== live && scope.live.count <= frame.samples.length, isKept: scope.buffer === live };
  });
  must(isNew && isKept, `anew: ${isNew}, what stands still is kept: ${isKept}`);
  await page.click("#scope-pause");
  const after = await seen();
  must(after.state === "running" && Math.abs(after.width - after.window) < 1e-6, `${after.state}, ${after.width} s are shown`);
  await page.click("#tab-machine");
}

// A double click shows all again; of its first click no cursor stays, and a scope that ran runs on.
async function aDoubleClickLeavesNoCursor({ page }) {
  await page.click("#tab-scope");
  const seen = () => page.evaluate(() => ({ state: meridian.scope.state.now, cursors: meridian.scope.cursors.filter((one) => one !== null).length }));
  await page.locator("#scope-plot-1 .u-over").dblclick();
  const after = await seen();
  must(after.state === "running" && after.cursors === 0, JSON.stringify(after));
  await page.locator("#scope-plot-1 .u-over").click();
  const one = await seen();
  must(one.state === "paused" && one.cursors === 1, JSON.stringify(one));
  await page.locator("#scope-plot-1 .u-over").dblclick();
  must((await seen()).cursors === 1, "a double click takes a cursor that was there");
  await page.click("#scope-pause");
  await page.click("#tab-machine");
}

// What an armed scope waits for counts from the new service on; what had fired is shown.
async function anArmedScopeOutlivesItsService({ page }) {
  await page.selectOption("#scope-trigger", "alarm", { force: true });
  const seen = await page.evaluate(() => {
    const { scope, frame } = meridian, states = [];
    const restart = (service) => (scope.setFrame({ ...frame, service, samples: [] }), states.push(`${scope.state.now} ${scope.trigger.isArmed}`));
    scope.arm();
    scope.trigger.before = { state: "Ready", alarm: null, lost: 0 };
    restart("second");
    states.push(String(scope.trigger.before?.alarm ?? null));
    scope.trigger.at = scope.live.end;
    const { live } = scope;
    restart("third");
    states.push(String(scope.buffer === live));
    scope.change("go");
    return states;
  });
  must(seen.join(", ") === "armed true, null, triggered false, true", seen.join(", "));
  await page.selectOption("#scope-trigger", "none", { force: true });
}

// A machine whose file its topic does not carry any more: no number, picture or button of before is left.
async function whatIsNotKnownAnyMoreGoes({ page }) {
  const machine = (scene) => page.evaluate((one) => {
    const { description } = meridian.view, kept = description ?? meridian.keptDescription;
    meridian.keptDescription = kept;
    meridian.link.onText({ t: "machine", scene: one ? kept : null, name: kept.name, host: "", version: "" });
  }, scene);
  await page.click("#jog-toggle");
  await until("buttons", () => visible(page, ".jog-row button"));
  await machine(false);
  must((await page.locator(".jog-row, .joint").count()) === 0 && (await visible(page, "#jog")) === 0, "joints of before are there");
  must((await page.locator("#jog-toggle:enabled").count()) === 0, "jogging is offered");
  must(await page.evaluate(() => meridian.view.machine === null), "the picture of before is there");
  must((await visible(page, "#no-picture")) === 1, "nothing says why");
  await page.evaluate(() => (["iso", "part"].forEach((one) => meridian.view.look(one)), meridian.view.follow(true), meridian.view.follow(false)));
  await machine(true);
  must((await page.locator(".joint").count()) > 0 && (await visible(page, "#no-picture")) === 0, "it does not come back");
}

// A trail from here to there: as frames bring it.
const drawTrail = (page) => page.evaluate(() => (meridian.view.trail.add([[0, 0, 0, 0, 0, 1, 1], [50, 0, 0, 0, 0, 1, 2]], 1), meridian.view.trail.count));

// No line goes across what nobody saw, or lies on a workpiece that was moved.
async function theTrailBeginsAnewAfterAGap({ page }) {
  const isGone = () => page.evaluate(() => meridian.view.trail.count < 2);
  must((await drawTrail(page)) >= 2, "no trail");
  await page.evaluate(() => meridian.link.socket.close());
  await until("the trail goes with the link", isGone, 5000);
  await until("a frame", () => page.evaluate(() => meridian.frame !== null));
  must((await drawTrail(page)) >= 2, "no trail");
  await page.evaluate(() => {
    const { description } = meridian.view, frame = { ...description.frame, origin: [10, 20, 30] };
    meridian.link.onText({ t: "machine", scene: { ...description, frame }, name: description.name, host: "", version: "" });
  });
  must(await isGone(), "the trail lies on a workpiece that was moved");
}

const opacityOf = (page, selector) => page.evaluate((what) => Number(getComputedStyle(document.querySelector(what)).opacity), selector);

async function aSilentServiceDimsThePage({ page }) {
  must((await opacityOf(page, "aside")) === 1, "dimmed while the service speaks");
  plant.service.kill("SIGSTOP");
  await until("Silent", async () => (await page.textContent("#state")) === "Silent");
  must((await opacityOf(page, "aside")) < 0.6 && (await opacityOf(page, ".picture")) < 0.6, "what was looks like what is");
  const enabled = ".console [data-verb]:enabled, .console input:enabled, .jog-row button:enabled";
  must((await page.locator(enabled).count()) === 0, "somebody seems to listen");
  plant.service.kill("SIGCONT");
  await until("a frame", () => page.evaluate(() => meridian.frame !== null));
  must((await opacityOf(page, "aside")) === 1, "it stays dimmed");
}

// The slider under a finger stays where the finger has it, whatever frames say meanwhile.
async function aSliderFollowsTheFingerAlone({ page }) {
  const box = await page.locator("#feed-slider").boundingBox(), y = box.y + box.height / 2;
  const value = () => page.evaluate(() => Number(document.getElementById("feed-slider").value));
  const fingers = await Fingers.of(page);
  await fingers.down([box.x + 0.6 * box.width, y]);
  await fingers.move([box.x + 0.3 * box.width, y]);
  const chosen = await value();
  must(chosen < 60, `the slider is at ${chosen} %`);
  await sleep(1200);
  must((await value()) === chosen, "a frame moved the slider under the finger");
  await fingers.up();
  for (let i = 0; i < 10; ++i) {
    must((await value()) === chosen, "the slider jumps back before the answer comes");
    await sleep(30);
  }
  await until("the override", () => page.evaluate((percent) => Math.round(100 * meridian.frame.feed_override) === percent, chosen));
  await setFeedOverride(page, 100);
}

// One finger turns the picture, two pinch it.
async function fingersTurnAndPinchThePicture({ page }) {
  await drawAt(page, 0.2);
  const [x, y] = await middleOf(page, "#picture"), fingers = await Fingers.of(page);
  const distance = () => page.evaluate(() => meridian.view.camera.position.distanceTo(meridian.view.controls.target));
  const pixel = () => page.evaluate(() => meridian.view.tipPixel());
  const first = await distance(), before = await pixel();
  await fingers.down([x - 40, y]);
  await fingers.move([x + 60, y]);
  await fingers.up();
  const turned = await pixel();
  must(Math.hypot(turned[0] - before[0], turned[1] - before[1]) > 1, "a finger does not turn it");
  await fingers.down([x - 40, y], [x + 40, y]);
  for (let i = 1; i <= 5; ++i) await fingers.move([x - 40 - 20 * i, y], [x + 40 + 20 * i, y]);
  await fingers.up();
  const pinched = await distance();
  must(pinched < 0.8 * first, `a pinch leaves the camera at ${pinched} of ${first} mm`);
  await page.evaluate(() => meridian.view.look("iso"));
  await drawAt(page, 1);
}

await runTests(plant, pictures, async (session, run) => {
  await plant.start();
  session.open = await openBrowser(playwright, plant);
  const { open } = session;
  await run("APanelThatWatchesOffersNothing", aPanelThatWatchesOffersNothing, open);
  await run("WithoutWebGlAllElseWorks", withoutWebGlAllElseWorks, open);
  await run("APictureThatFailsLeavesTheButtons", aPictureThatFailsLeavesTheButtons, open);
  await run("OnlyOneProgramIsDropped", onlyOneProgramIsDropped, open);
  await run("APathThatDoesNotComeIsAskedForAgain", aPathThatDoesNotComeIsAskedForAgain, open);
  await run("ASmallPartFillsItsView", aSmallPartFillsItsView, open);
  await run("TheThemeIsTheSystemsUntilSomebodyChooses", theThemeIsTheSystemsUntilSomebodyChooses, open);
  await run("TimesHave24Hours", timesHave24Hours, open);
  await run("TheScopeZoomsAndBeginsAnew", theScopeZoomsAndBeginsAnew, open);
  await run("ADoubleClickLeavesNoCursor", aDoubleClickLeavesNoCursor, open);
  await run("AnArmedScopeOutlivesItsService", anArmedScopeOutlivesItsService, open);
  await run("WhatIsNotKnownAnyMoreGoes", whatIsNotKnownAnyMoreGoes, open);
  await run("TheTrailBeginsAnewAfterAGap", theTrailBeginsAnewAfterAGap, open);
  await run("ASilentServiceDimsThePage", aSilentServiceDimsThePage, open);
  await run("ASliderFollowsTheFingerAlone", aSliderFollowsTheFingerAlone, open);
  await run("FingersTurnAndPinchThePicture", fingersTurnAndPinchThePicture, open);
});
