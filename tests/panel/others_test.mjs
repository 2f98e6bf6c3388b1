// SPDX-License-Identifier: Apache-2.0
// The page where something is missing or somebody else is in charge: it says so, and the rest works on.
import { kSmall, openBrowser, until } from "./plant.mjs";
import { must, runTests } from "./page_hand.mjs";
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

await runTests(plant, pictures, async (session, run) => {
  await plant.start();
  session.open = await openBrowser(playwright, plant);
  const { open } = session;
  await run("APanelThatWatchesOffersNothing", aPanelThatWatchesOffersNothing, open);
});
