// SPDX-License-Identifier: Apache-2.0
// A service, its drives and a panel in a domain of their own, and a browser in front of it.
import { spawn, execFileSync } from "node:child_process";
import { closeSync, existsSync, fstatSync, mkdtempSync, openSync, readdirSync, readFileSync, readSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createServer } from "node:tls";

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

export async function until(what, isTrue, ms = 20000) {
  const end = Date.now() + ms;
  for (;;) {
    const value = await isTrue();
    if (value) return value;
    if (Date.now() > end) throw new Error(`time is up: ${what}`);
    await sleep(30);
  }
}

export class Plant {
  constructor(bin, source, machine) {
    Object.assign(this, { bin, source, machine: join(source, "deploy/machines", machine) });
    this.domain = String(170 + (process.pid % 30));
    this.folder = mkdtempSync(join(tmpdir(), "meridian-panel-"));
    this.children = [];
    this.env = { ...process.env };
    delete this.env.CYCLONEDDS_URI;  // the programs' own way on one host: their threads keep their class
  }

  spawn(program, ...words) {
    const child = spawn(join(this.bin, program), words, { env: this.env });
    child.text = "";
    for (const stream of [child.stdout, child.stderr]) stream.on("data", (data) => (child.text += data));
    child.ended = new Promise((resolve) => child.on("exit", resolve));
    this.children.push(child);
    return child;
  }

  tool(...words) {
    try {
      return execFileSync(join(this.bin, "meridian"), words, { env: this.env, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
    } catch (error) {
      return `failed (${error.status}): ${error.stdout}${error.stderr}`;
    }
  }

  status() {
    const text = this.tool("status", "--json", "--domain", this.domain);
    return text.startsWith("{") ? JSON.parse(text) : { state: "" };
  }

  // The newest rows of the service's recording, some thirty thousand cycles: texts by the name of their column.
  newestRows() {
    const file = openSync(this.recording), kTail = 1 << 23;
    const read = (from, count) => {
      const bytes = Buffer.alloc(count);
      return bytes.toString("latin1", 0, readSync(file, bytes, 0, count, from));
    };
    const names = read(0, 4096).split("\n")[0].split(","), size = fstatSync(file).size;
    const lines = read(Math.max(0, size - kTail), Math.min(size, kTail)).split("\n").slice(1, -1);
    closeSync(file);
    return lines.map((line) => Object.fromEntries(line.split(",").map((text, i) => [names[i], text])));
  }

  // `tool`: a number that the table has beside its own.
  async start({ tool } = {}) {
    this.recording = join(this.folder, "recording.csv");
    this.tools = join(this.folder, "tools.toml");
    const service = join(this.folder, "service.toml");
    const own = tool ? `\n[[tool]]\nnumber = ${tool}\nlength_mm = 100\nradius_mm = 5\n` : "";
    writeFileSync(this.tools, readFileSync(join(this.source, "deploy/tools.toml"), "utf8") + own);
    writeFileSync(service, readFileSync(join(this.source, "deploy/service.toml"), "utf8"));
    this.startService();
    this.drives = this.spawn("meridian", "drives", "--machine", this.machine, "--domain", this.domain, "--console");
    this.panel = await this.startPanel();
  }

  startService() {
    this.service = this.spawn("meridiand", "--machine", this.machine, "--service", join(this.folder, "service.toml"), "--domain", this.domain,
      "--best-effort", "--record", this.recording);
  }

  async restartService() {
    this.service.kill("SIGTERM");
    await this.service.ended;
    this.startService();
  }

  // The sample part, made once.
  part() {
    const file = join(this.folder, "part.apt");
    if (!existsSync(file)) this.tool("surface", "--sample", "blossom", "-o", file);
    return file;
  }

  async startPanel() {
    const { panel, url } = await this.spawnPanel();
    this.url = url;
    return panel;
  }

  async spawnPanel(...words) {
    const panel = this.spawn("meridian", "panel", "--domain", this.domain, "--port", "0", "--timeout", "20", ...words);
    const url = await until("the panel says where it is", () => /http:\S+/.exec(panel.text)?.[0], 30000);
    return { panel, url };
  }

  // A panel with a token behind a TLS proxy with a certificate of its own.
  async startPanelElsewhere() {
    const file = (name) => join(this.folder, name), token = "0123456789abcdef0123456789abcdef";
    execFileSync("openssl", ["req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2",
      "-subj", "/CN=localhost", "-keyout", file("key.pem"), "-out", file("certificate.pem")], { stdio: "ignore" });
    writeFileSync(file("token"), `${token}\n`, { mode: 0o600 });
    let target = null;
    const proxy = createServer({ key: readFileSync(file("key.pem")), cert: readFileSync(file("certificate.pem")) }, (outside) => {
      const inside = connect(target, "127.0.0.1");
      outside.pipe(inside).pipe(outside);
      outside.on("error", () => inside.destroy());
      inside.on("error", () => outside.destroy());
    });
    await new Promise((resolve) => proxy.listen(0, "127.0.0.1", resolve));
    const secured = `https://localhost:${proxy.address().port}`;
    const { panel, url } = await this.spawnPanel("--public", secured, "--token", file("token"));
    target = Number(new URL(url).port);
    return { panel, url, secured, token, proxy, tokenFile: file("token") };
  }

  async end() {
    for (const child of this.children.splice(0).reverse()) {
      child.kill("SIGTERM");
      const isOver = await Promise.race([child.ended.then(() => true), sleep(5000)]);
      if (!isOver) child.kill("SIGKILL");
    }
  }

  async stop() {
    await this.end();
    rmSync(this.folder, { recursive: true, force: true });
  }
}

// The resident memory of a process, KiB.
export function memoryOf(pid) {
  return Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]);
}

// The time that a process took of all cores, s.
export function cpuSecondsOf(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").replace(/^.*\) /, "").split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

// A process and all that it started.
export function familyOf(pid) {
  const parents = new Map();
  for (const name of readdirSync("/proc").filter((entry) => /^\d+$/.test(entry))) {
    try {
      const fields = readFileSync(`/proc/${name}/stat`, "utf8").replace(/^.*\) /, "").split(" ");
      parents.set(Number(name), Number(fields[1]));
    } catch {
      // It ended meanwhile.
    }
  }
  const family = [pid];
  for (const one of family) for (const [child, parent] of parents) if (parent === one) family.push(child);
  return family;
}

export const kSmall = { width: 1280, height: 800 }, kPicture = { width: 1600, height: 900 }, kLarge = { width: 1920, height: 1080 };
export const kChromium = "/usr/bin/chromium";

// Playwright from where npm fetched it; nothing where it or the browser is not there.
export function findPlaywright(fetched) {
  const parts = ["playwright-core", "axe-core"].map((name) => join(fetched, "node_modules", name));
  if (!existsSync(kChromium) || !parts.every((path) => existsSync(path))) return null;
  return createRequire(join(fetched, "package.json"))("playwright-core");
}

// Rendering in software would take both cores of a small host: the machine comes first. MERIDIAN_PANEL_POLITE=0: it may.
const kPolite = process.env.MERIDIAN_PANEL_POLITE === "0" ? "nice -n 0" : "nice -n 19 taskset -c 0";

// Drawn in software, the picture takes a whole core wherever the machine moves: six pictures a second do where none is measured.
const kPicture_ms = 150;
const drawRarely = (wait_ms) => {
  const draw = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (step) => setTimeout(() => draw(step), wait_ms);
};

export async function openBrowser(playwright, { url, folder }, { theme = "dark", isEachFrameDrawn = false } = {}) {
  const polite = join(folder, "chromium");
  writeFileSync(polite, `#!/bin/sh\nexec ${kPolite} ${kChromium} "$@"\n`, { mode: 0o755 });
  const server = await playwright.chromium.launchServer({ executablePath: polite, headless: true,
    // WebGL in software. The page itself is not drawn by it: that takes three times as long.
    args: ["--no-sandbox", "--enable-unsafe-swiftshader"] });
  const browser = await playwright.chromium.connect(server.wsEndpoint());
  const context = await browser.newContext({ viewport: kSmall, colorScheme: theme });
  if (!isEachFrameDrawn) await context.addInitScript(drawRarely, kPicture_ms);
  const page = await context.newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  await page.goto(url);
  return { server, browser, page, errors, pid: server.process().pid };
}
