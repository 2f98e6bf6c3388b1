// SPDX-License-Identifier: Apache-2.0
// Every view of the page in a real browser: what it shows is what the machine says, by keys alone too.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { kSmall, openBrowser, sleep, until } from "./plant.mjs";
import { afterStalls, drawAt, enabled, go, goBy, goConfirmed, inState, load, must, phase, picture, runTests, setFeedOverride, stateOf } from "./page_hand.mjs";
import { fetched, pictures, plant, playwright } from "./browser_case.mjs";

// ---- the numbers beside the picture

const kJoints = [["b3_mm", false], ["b2_mm", false], ["b4_mm", false], ["theta1_rad", true], ["theta2_rad", true]];

// Statuses and frames of the same sequence, while the part is cut.
async function theNumbersAreThoseOfTheStatus({ page }) {
  await afterStalls(page, async () => {
    await enabled(page);
    await setFeedOverride(page, 40);
    await load(page, plant.part());
    await inState(page, "Loaded");
    await goConfirmed(page, "start", "Running");
    await page.evaluate(() => {
      // What stood on the page when each frame had been shown.
      const shown = (globalThis.shownFrames = new Map());
      const text = (id) => document.getElementById(id).textContent;
      const original = meridian.display.setFrame.bind(meridian.display);
      meridian.display.setFrame = (frame) => {
        original(frame);
        shown.set(frame.sequence, {
          tip: ["tip-x", "tip-y", "tip-z"].map(text), axis: ["axis-i", "axis-j", "axis-k"].map(text), feed: text("feed"),
          joints: [...document.querySelectorAll("#joints .value")].map((one) => one.textContent),
          limiting: document.querySelector("#joints .limits b")?.textContent ?? "", state: text("state"),
          block: text("block"),
        });
      };
    });
    let compared = 0;
    for (let i = 0; i < 60 && compared < 12; ++i) {
      const status = plant.status();
      const seen = await until("the frame of the status", () => page.evaluate((sequence) => globalThis.shownFrames.get(sequence), status.status_sequence), 400).catch(() => null);
      if (!seen || status.state !== "Running") continue;
      compare(seen, status);
      ++compared;
    }
    must(compared >= 12, `only ${compared} statuses were met`);
    await page.reload();
    await until("a frame", () => page.evaluate(() => globalThis.meridian?.frame != null));
    await go(page, "abort", "Ready");
    await setFeedOverride(page, 100);
  });
}

function compare(seen, status) {
  const number = (text) => Number(text.replaceAll("\u2212", "-"));
  const near = (text, value, digits, what) =>
    must(Math.abs(number(text) - value) <= 0.501 * 10 ** -digits, `${what}: the page shows ${text}, the status says ${value}`);
  seen.tip.forEach((text, i) => near(text, status.tip_mm[i], 3, "tip"));
  seen.axis.forEach((text, i) => near(text, status.tool_axis[i], 4, "axis"));
  near(seen.feed, status.feed_achieved_mm_per_min, 0, "feed");
  kJoints.forEach(([name, isRotary], i) => near(seen.joints[i], isRotary ? (status[name] * 180) / Math.PI : status[name], isRotary ? 4 : 3, name));
  must(seen.limiting === status.limiting, `the page marks "${seen.limiting}", the status says "${status.limiting}" limits`);
  must(seen.block === `block ${status.block} of ${status.block_count}`, `the page shows ${seen.block}, the status block ${status.block}`);
}

// ---- the path by what holds the feed

// Of each block, the limit that holds it longest in the picture is the one that `simulate --explain-table` names.
async function theColoursAgreeWithExplain({ page }) {
  const table = join(plant.folder, "explained.csv");
  plant.tool("simulate", plant.part(), "--machine", plant.machine, "--tools", plant.tools, "--explain-table", table);
  const [head, ...rows] = readFileSync(table, "utf8").trim().split("\n").map((line) => line.split(","));
  const shares = head.flatMap((name, at) => (name.startsWith("share_") ? [at] : [])), line = head.indexOf("line");
  await page.click("#tab-program");
  await page.setInputFiles("#program-file", plant.part());
  await phase(page, "ready", 60000);
  const { byLine: held, byHeld } = await until("the path", () => page.evaluate(() => {
    const { path } = meridian.program, byLine = {};
    if (path === null) return null;
    for (let i = 1; i < path.count; ++i) {
      const one = (byLine[path.line[i]] ??= {});
      one[path.limit[i]] = (one[path.limit[i]] ?? 0) + path.time[i] - path.time[i - 1];
    }
    return { byLine, byHeld: Object.fromEntries(path.byHeld()) };
  }));
  causesAgree(byHeld, head, rows);
  let compared = 0;
  for (const row of rows) {
    const values = shares.map((at) => Number(row[at])), top = Math.max(...values), drawn = held[Number(row[line])];
    // Where two limits share a block evenly, a cycle more or less decides; a block of a few cycles is all ends.
    const seconds = drawn ? Object.values(drawn).reduce((sum, value) => sum + value, 0) : 0;
    if (!(top > 0.65) || seconds < 0.02) continue;
    const longest = Number(Object.keys(drawn).reduce((a, b) => (drawn[a] >= drawn[b] ? a : b)));
    must(longest === values.indexOf(top), `line ${row[line]}: drawn as limit ${longest}, explained as ${head[shares[values.indexOf(top)]]}`);
    ++compared;
  }
  console.log(`  ${compared} blocks compared`);
  must(compared > 60, `only ${compared} blocks were compared`);
}

// Rests and singularities have colours of their own: as long as the explanation says.
function causesAgree(drawn, head, rows) {
  const explained = (name) => rows.reduce((sum, row) => sum + Number(row[head.indexOf(name)]) * Number(row[head.indexOf("time_s")]), 0);
  for (const [held, name] of [[259, "why_pole"], [260, "why_rest"]]) {
    const seconds = explained(name);
    must(Math.abs((drawn[held] ?? 0) - seconds) < 0.05 * seconds + 0.05, `${name}: ${drawn[held]} s are drawn, ${seconds} s explained`);
  }
  must(explained("why_rest") > 0.1, "nothing rests");
}

// ---- a run as one file

async function aRunAsOneFileOpensFromADisk({ browser, page: live }) {
  await drawAt(live, 0.1);
  const file = join(plant.folder, "run.html");
  const said = plant.tool("simulate", plant.part(), "--machine", plant.machine, "--tools", plant.tools, "--html", file);
  must(!said.startsWith("failed"), said);
  const page = await (await browser.newContext({ viewport: kSmall, colorScheme: "dark" })).newPage();
  const asked = [], errors = [];
  page.on("request", (request) => asked.push(request.url()));
  page.on("pageerror", (error) => errors.push(error.message));
  await page.goto(`file://${file}`, { timeout: 90000 });
  await until("the run", () => page.evaluate(() => globalThis.meridian?.report?.count > 100));
  const at = (i) => page.evaluate((moment) => {
    const scrub = document.getElementById("scrub");
    scrub.value = String(moment);
    scrub.dispatchEvent(new Event("input"));
    return ["moment", "tip-x", "line"].map((id) => document.getElementById(id).textContent);
  }, i);
  const count = await page.evaluate(() => meridian.report.count);
  const [early, late] = [await at(Math.floor(0.3 * count)), await at(Math.floor(0.6 * count))];
  must(early.every((text, i) => text !== "" && text !== late[i]), `nothing changes with time: ${early}, ${late}`);
  await page.click("#play");
  await until("it plays", async () => (await page.textContent("#moment")) !== late[0]);
  await page.click("#play");
  await page.evaluate(() => meridian.view.look("part"));
  must(asked.every((url) => url.startsWith("file:") || url.startsWith("data:") || url.startsWith("blob:")), `it asks for ${asked}`);
  must(errors.length === 0, errors.join("; "));
  await picture(page, pictures, "panel-viewer");
  await page.context().close();
  await drawAt(live, 1);
}

// ---- by keys alone

// Tab until the focus is there.
async function focus(page, selector) {
  for (let i = 0; i < 90; ++i) {
    if (await page.evaluate((wanted) => document.activeElement?.matches(wanted) ?? false, selector)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error(`the keyboard does not come to ${selector}`);
}
async function push(page, selector) {
  await until(`${selector} is there`, () => page.isEnabled(selector));
  await focus(page, selector);
  await page.keyboard.press("Enter");
}

const theKeyboardAloneRunsThePart = ({ page }) => afterStalls(page, () => onePartByKeys(page));

async function onePartByKeys(page) {
  if ((await stateOf(page)) === "Off") await push(page, '[data-verb="enable"]');
  await inState(page, "Ready");
  await focus(page, "[role=tab][aria-selected=true]");
  while (!(await page.evaluate(() => document.activeElement.id === "tab-program"))) await page.keyboard.press("ArrowRight");
  const chooser = page.waitForEvent("filechooser");
  await push(page, "#program-choose");
  await (await chooser).setFiles(plant.part());
  await phase(page, "ready", 60000);
  await push(page, "#program-load");
  await inState(page, "Loaded");
  await goBy(page, async () => {
    await push(page, '[data-verb="start"]');
    await push(page, "#confirm-yes");
  }, "Running");
  await page.keyboard.press("Escape");
  await inState(page, "Held");
  await overrideByKeys(page);
  await goBy(page, async () => {
    await push(page, '[data-verb="resume"]');
    await push(page, "#confirm-yes");
  }, "Running");
  await theTimeToGoIsRight(page);
  must(plant.status().message.includes("ran to its end"), plant.status().message);
}

// What the page says in the middle of the part, against the cycles in which the plan then went on: how long somebody takes to
// stop a spindle at the end is in no plan.
async function theTimeToGoIsRight(page) {
  const seen = await until("the middle of the part", () => page.evaluate(() => {
    const { frame, program } = meridian, toGo = program.path && frame.plan_time_s > 0 ? program.toGo(frame) : 0;
    return frame.samples.length > 0 && toGo > 2 && toGo < 0.7 * program.program.program_s && { toGo, cycle: frame.samples.at(-1)[0] };
  }));
  await inState(page, "Ready", 60000);
  await sleep(200);
  const rows = plant.newestRows().filter((row) => Number(row.cycle) >= seen.cycle);
  const passed = rows.slice(1).map((row, i) => (row.state === "running" && row.plan_time_s !== rows[i].plan_time_s ? row.cycle - rows[i].cycle : 0));
  const took = 1e-3 * passed.reduce((sum, cycles) => sum + cycles, 0);
  console.log(`  ${seen.toGo.toFixed(2)} s to go, it took ${took.toFixed(2)} s`);
  must(took > 2 && Math.abs(seen.toGo - took) < 0.05 * took, `${seen.toGo} s to go, it took ${took} s`);
}

// Up by two steps of the slider, and back: the part is cut as it was programmed.
async function overrideByKeys(page) {
  await focus(page, "#feed-slider");
  for (const [key, percent] of [["ArrowRight", 105], ["ArrowRight", 110], ["ArrowLeft", 105], ["ArrowLeft", 100]]) {
    await page.keyboard.press(key);
    await until(`${percent} %`, async () => Math.round(100 * (await page.evaluate(() => meridian.frame.feed_override))) === percent);
  }
}

// ---- scope and timing

const rowsOf = (text) => text.trim().split("\n").slice(1).map((line) => line.split(",").map(Number));

// Every cycle that the wire had; what is saved can be opened again; a trigger stops it; cursors stand.
async function theScopeShowsEveryCycle({ page }) {
  await page.click("#tab-scope");
  await page.selectOption("#scope-window", "5");
  await until("samples", async () => (await page.evaluate(() => meridian.scope.live.count)) > 3000);
  await page.click("#scope-pause");
  const file = await saved(page, "#scope-csv", "scope.csv");
  const rows = rowsOf(readFileSync(file, "utf8"));
  const gaps = rows.filter((row, i) => i > 0 && row[0] - rows[i - 1][0] > 1).length;
  must(rows.length > 2000 && gaps < 0.05 * rows.length, `${rows.length} rows with ${gaps} gaps`);
  await theMcapFileHasTheSameRows(await saved(page, "#scope-mcap", "scope.mcap"), rows);
  await page.setInputFiles("#scope-file", file);
  await until("the recording", async () => (await page.textContent("#scope-report")).includes(`${rows.length} cycles`));
  must((await page.evaluate(() => meridian.scope.buffer.cycle[0])) === rows[0][0], "the recording begins elsewhere");
  await page.setInputFiles("#scope-file", { name: "wrong.csv", mimeType: "text/csv", buffer: Buffer.from("a,b\n1,2\n") });
  await until("a refusal", async () => (await page.textContent("#scope-report")).includes("no recording of this machine"));
  await page.click("#scope-live");
}

// Read by the library of the format.
async function theMcapFileHasTheSameRows(file, rows) {
  const { McapIndexedReader } = createRequire(join(fetched, "package.json"))("@mcap/core");
  const bytes = readFileSync(file);
  const readable = { size: async () => BigInt(bytes.length), read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)) };
  const reader = await McapIndexedReader.Initialize({ readable });
  const messages = [];
  for await (const message of reader.readMessages()) messages.push(JSON.parse(new TextDecoder().decode(message.data)));
  must(messages.length === rows.length, `${messages.length} messages of ${rows.length} cycles`);
  must(messages.every((one, i) => one.cycle === rows[i][0] && one.position.b3_mm === rows[i][2]), "a message is not its row");
}

async function saved(page, button, name) {
  const download = page.waitForEvent("download");
  await page.click(button);
  const file = join(plant.folder, name);
  await (await download).saveAs(file);
  return file;
}

async function aTriggerStopsTheScope({ page }) {
  await afterStalls(page, () => enabled(page));
  await page.click("#tab-scope");
  await page.selectOption("#scope-window", "1");
  await page.selectOption("#scope-trigger", "state");
  await page.selectOption("#scope-state", "Ready");
  await page.click("#scope-arm");
  await go(page, "disable", "Off");
  await go(page, "enable", "Ready");
  await until("the trigger", () => page.evaluate(() => meridian.scope.state.now === "triggered"), 10000);
  const box = await page.locator("#scope-plot-1 .u-over").boundingBox();
  for (const share of [0.3, 0.6]) await page.mouse.click(box.x + share * box.width, box.y + box.height / 2);
  must((await page.textContent("#scope-readout")).includes("B \u2212 A"), "no cursors");
  await picture(page, pictures, "panel-scope");
}

async function theStagesStandBesideTheirBudgets({ page }) {
  await page.click("#tab-timing");
  await until("stages", async () => (await page.locator(".stage-card").count()) >= 6);
  must((await page.textContent("#timing-stages")).includes("budget"), "no budgets");
  const [said] = JSON.parse(plant.tool("doctor", "--json", "--no-dds").replace(/^failed \(\d+\): /, "")).findings.filter(({ what }) => what === "kernel");
  await until("what doctor finds", async () => (await page.textContent("#timing-doctor")).includes(said.found));
  await picture(page, pictures, "panel-timing");
  await page.click("#tab-machine");
}

async function faultsOf(page, what) {
  await sleep(300);
  const { violations } = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
  return violations.filter(({ impact }) => impact === "serious" || impact === "critical")
    .map(({ id, impact, nodes }) => `${what}: ${impact} ${id} at ${nodes.slice(0, 3).map((node) => node.target.join(" ")).join(", ")}`);
}

// Every view in both themes, with what opens over it, by the rules that axe-core calls serious or critical.
async function everyViewIsAccessible({ page }) {
  await drawAt(page, 0.1);
  await page.evaluate(createRequire(join(fetched, "package.json"))("axe-core").source);
  const faults = [];
  for (const theme of ["dark", "light"]) {
    await page.evaluate((name) => (document.documentElement.dataset.theme = name), theme);
    for (const view of ["machine", "program", "scope", "timing"]) {
      await page.click(`#tab-${view}`);
      faults.push(...(await faultsOf(page, `${theme}, ${view}`)));
    }
    await page.click("#tab-machine");
    await page.click("#jog-toggle");
    await page.evaluate(() => meridian.actions.setOpen([{ id: "1", line: 6, text: "change to tool 2" }]));
    faults.push(...(await faultsOf(page, `${theme}, jog and action`)));
    await page.click("#actions .go");
    faults.push(...(await faultsOf(page, `${theme}, question`)));
    await page.click("#confirm-no");
    await page.evaluate(() => meridian.actions.setOpen([]));
    await page.click("#jog-toggle");
  }
  await drawAt(page, 1);
  await afterStalls(page, async () => {
    await enabled(page);
  });
  must(faults.length === 0, faults.join("\n"));
}


await runTests(plant, pictures, async (session, run) => {
  await plant.start();
  session.open = await openBrowser(playwright, plant);
  const { open } = session;
  await run("TheNumbersAreThoseOfTheStatus", theNumbersAreThoseOfTheStatus, open);
  await run("TheColoursAgreeWithExplain", theColoursAgreeWithExplain, open);
  await run("ARunAsOneFileOpensFromADisk", aRunAsOneFileOpensFromADisk, open);
  await run("TheKeyboardAloneRunsThePart", theKeyboardAloneRunsThePart, open);
  await run("TheScopeShowsEveryCycle", theScopeShowsEveryCycle, open);
  await run("ATriggerStopsTheScope", aTriggerStopsTheScope, open);
  await run("TheStagesStandBesideTheirBudgets", theStagesStandBesideTheirBudgets, open);
  await run("EveryViewIsAccessible", everyViewIsAccessible, open);
});
