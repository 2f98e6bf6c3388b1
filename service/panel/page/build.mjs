// SPDX-License-Identifier: Apache-2.0
// build.mjs IN OUT: bundles the page of IN into OUT: packed files for the server, and one HTML file that needs none.
import { readFileSync, writeFileSync } from "node:fs";
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

// What others wrote, with their licences.
const notices = () =>
  ["three", "uplot"]
    .map((name) => {
      const folder = join(out, "node_modules", name);
      const { version } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
      return `${name} ${version}\n\n${readFileSync(join(folder, "LICENSE"), "utf8")}`;
    })
    .join("\n\n");

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
