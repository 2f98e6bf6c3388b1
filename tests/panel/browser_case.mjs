// SPDX-License-Identifier: Apache-2.0
// What a test in a browser is called with: BIN SOURCE FETCHED PICTURES [MACHINE]. Skipped by name where there is no browser.
import { mkdirSync } from "node:fs";
import { join, resolve } from "node:path";
import { findPlaywright, Plant } from "./plant.mjs";

const [bin, source, fetchedFolder, picturesFolder] = process.argv.slice(2).map((path) => resolve(path));
// The pages show some of the pictures: MERIDIAN_REGENERATE=1 makes these anew.
export const fetched = fetchedFolder, pictures = process.env.MERIDIAN_REGENERATE ? join(source, "docs/images/panel") : picturesFolder;
export const playwright = findPlaywright(fetched);
if (!playwright) {
  console.log("SKIPPED: chromium or playwright-core is not here (deploy/install_packages browser)");
  process.exit(77);
}
mkdirSync(pictures, { recursive: true });
export const plant = new Plant(bin, source, "lai.toml");
