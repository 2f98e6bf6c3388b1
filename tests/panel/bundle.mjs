// SPDX-License-Identifier: Apache-2.0
// bundle.mjs OUT ENTRY ARGS...: runs ENTRY with what npm fetched to OUT for the page, as the page itself is bundled.
import { createRequire } from "node:module";
import { basename, join } from "node:path";
import { pathToFileURL } from "node:url";

const [out, entry] = process.argv.slice(2);
const { build } = createRequire(join(out, "package.json"))("esbuild");
const outfile = join(out, `test-${basename(entry)}.mjs`);
await build({ entryPoints: [entry], bundle: true, platform: "node", format: "esm", outfile, nodePaths: [join(out, "node_modules")] });
await import(pathToFileURL(outfile));
