// SPDX-License-Identifier: Apache-2.0
// build.mjs IN OUT: bundles the page of IN into OUT: packed files for the server, and one HTML file that needs none.
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { gzipSync } from "node:zlib";
import { join } from "node:path";

const [source, out] = process.argv.slice(2);
// What npm fetched lies in OUT: nothing of others comes between the sources.
const { build } = createRequire(join(out, "package.json"))("esbuild");
const bundle = async (entry, format) => {
  const result = await build({
    entryPoints: [join(source, entry)],
    bundle: true,
    minify: true,
    write: false,
    format,
    target: "es2022",
    outdir: out,
    legalComments: "none",
    nodePaths: [join(out, "node_modules")],
  });
  return result.outputFiles[0].text;
};

// What others wrote and the page carries, with their licences.
const lock = JSON.parse(readFileSync(join(out, "package-lock.json"), "utf8"));
const carried = Object.entries(lock.packages).filter(([path, { dev }]) => path !== "" && !dev);
const licence = (folder) => readFileSync(join(folder, readdirSync(folder).find((name) => /^licen[cs]e/i.test(name))), "utf8");
const notices = () =>
  carried.map(([path, { version }]) => `${path.replace("node_modules/", "")} ${version}\n\n${licence(join(out, path))}`).join("\n\n");

const pack = (name, text) => writeFileSync(join(out, `${name}.gz`), gzipSync(text, { level: 9 }));

const script = await bundle("src/panel.js", "esm");
const style = await bundle("panel.css");
const html = readFileSync(join(source, "index.html"), "utf8");
pack("panel.js", script);
pack("panel.css", style);
pack("index.html", html);
pack("notices.txt", notices());

const inline = html
  .replace(/<link rel="stylesheet"[^>]*>/, () => `<style>${style}</style>`)
  .replace(/<script[^>]*><\/script>/, () => {
    const safe = script.replaceAll("</script", "<\\/script");
    return `<script type="application/json" id="report">MERIDIAN_REPORT</script>\n<script type="module">${safe}</script>`;
  })
  .replace("</body>", () => `<!--\n${notices().replaceAll("--", "- -")}\n-->\n</body>`);
writeFileSync(join(out, "viewer.html"), inline);
