// SPDX-License-Identifier: Apache-2.0
// The page where something is missing or somebody else is in charge: it says so, and the rest works on.
import { join } from "node:path";
import { kSmall, openBrowser, until } from "./plant.mjs";
import { afterStalls, enabled, go, must, runTests } from "./page_hand.mjs";
import { pictures, plant, playwright } from "./browser_case.mjs";

async function pageAt(browser, url, prepare = () => {}) {
  const page = await (await browser.newContext({ viewport: kSmall })).newPage();
  await page.addInitScript(prepare);
  await page.goto(url);
  await until("a frame", () => page.evaluate(() => globalThis.meridian?.frame != null));
  return page;
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
  await page.keyboard.press("Escape");
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

// The page, and a run as one file.
async function withoutWebGlAllElseWorks({ browser }) {
  const page = await pageAt(browser, plant.url, withoutWebGl);
  await theReasonIsThere(page);
  must((await page.textContent("#tip-x")) !== "\u2013", "no numbers");
  await afterStalls(page, () => enabled(page));
  await page.setInputFiles("#program-file", plant.part());
  await until("the path's colours", async () => (await page.locator("#program-limits li").count()) > 0, 60000);
  await go(page, "disable", "Off");
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

await runTests(plant, pictures, async (session, run) => {
  await plant.start();
  session.open = await openBrowser(playwright, plant);
  const { open } = session;
  await run("APanelThatWatchesOffersNothing", aPanelThatWatchesOffersNothing, open);
  await run("WithoutWebGlAllElseWorks", withoutWebGlAllElseWorks, open);
});
