// SPDX-License-Identifier: Apache-2.0
// How fast the page comes and turns with a long program on it. MERIDIAN_PANEL_BLOCKS: how many blocks (20000). Absolute limits
// are for a quiet host: MERIDIAN_PANEL_FRAMES, MERIDIAN_PANEL_FIRST_MS; else the path is measured against the page without it.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { cpuSecondsOf, kLarge, memoryOf, openBrowser, sleep, until } from "./plant.mjs";
import { enabled, must, phase, runTests } from "./page_hand.mjs";
import { pictures, plant, playwright } from "./browser_case.mjs";

const kBlocks = Number(process.env.MERIDIAN_PANEL_BLOCKS ?? 20000);
const kMinFrames = Number(process.env.MERIDIAN_PANEL_FRAMES ?? 0), kMaxFirst_ms = Number(process.env.MERIDIAN_PANEL_FIRST_MS ?? 60000);
const kMaxBytes = 1e6;

// To and fro on a dome, the tool along the normal of it.
function longProgram() {
  const rows = ["PARTNO/LONG", "UNITS/MM", "MULTAX/ON", "FEDRAT/6000,MMPM"];
  for (let i = 0; i < kBlocks; ++i) {
    const share = i / kBlocks, turn = 2.5 * Math.sin(2 * Math.PI * 60 * share), tilt = 0.1 + 0.35 * share, radius = 150;
    const [x, y, z] = [Math.sin(tilt) * Math.cos(turn), Math.sin(tilt) * Math.sin(turn), Math.cos(tilt)];
    const text = [radius * x, radius * y, radius * z - 100, x, y, z].map((value) => value.toFixed(6)).join(",");
    rows.push(`GOTO/${text}`);
  }
  const file = join(plant.folder, "long.apt");
  writeFileSync(file, `${rows.join("\n")}\nFINI\n`);
  return file;
}

async function thePageIsSmall() {
  let bytes = 0;
  for (const path of ["/", "/panel.js", "/panel.css"]) {
    const answer = await fetch(new URL(path, plant.url), { headers: { "Accept-Encoding": "gzip" } });
    bytes += Number(answer.headers.get("content-length"));
    must(answer.ok, `${path} is not there`);
  }
  console.log(`  ${bytes} bytes, packed`);
  must(bytes > 50000 && bytes < kMaxBytes, `the page has ${bytes} bytes`);
}

async function theFirstPictureComesSoon({ page }) {
  const begin = Date.now();
  await page.goto(plant.url);
  const loaded = Date.now();
  await until("a picture", () => page.evaluate(() => globalThis.meridian?.frame != null && meridian.view.frames > 0).catch(() => false), 60000);
  const took = Date.now() - begin;
  console.log(`  first picture after ${took} ms, ${Date.now() - loaded} ms after the page was loaded`);
  must(took < kMaxFirst_ms, `the first picture came after ${took} ms`);
}

// The camera goes round, as far away as it is; every frame that is drawn counts.
const framesPerSecond = (page, seconds) => page.evaluate(async (duration_ms) => {
  const { view } = meridian;
  const { target } = view.controls, aside = view.camera.position.distanceTo(target) * Math.SQRT1_2;
  const begin = performance.now(), drawn = view.frames;
  for (;;) {
    const now = await new Promise((done) => requestAnimationFrame(done));
    if (now - begin > duration_ms) return (1000 * (view.frames - drawn)) / (now - begin);
    const angle = 0.001 * (now - begin);
    view.camera.position.set(target.x + aside * Math.cos(angle), target.y + aside * Math.sin(angle), target.z + aside);
    view.controls.update();
    view.ask();
  }
}, 1000 * seconds);

// How far, in pixels, the points that are left out lie off the line that is drawn, and how many are drawn.
const leftOut = (page) => page.evaluate(() => {
  const { camera, canvas, path } = meridian.view;
  const { line, drawn, index, count, geometry } = path.line;
  const pixels = Array.from({ length: count }, (_, i) => {
    const at = camera.position.clone().fromBufferAttribute(geometry.attributes.position, i).applyMatrix4(line.matrixWorld).project(camera);
    return [(at.x * canvas.width) / 2, (at.y * canvas.height) / 2];
  });
  let off = 0;
  for (let k = 1; k < drawn; ++k) {
    const from = index.array[k - 1], to = index.array[k], [ax, ay] = pixels[from];
    const dx = pixels[to][0] - ax, dy = pixels[to][1] - ay, length = dx * dx + dy * dy;
    for (let i = from + 1; i < to; ++i) {
      const px = pixels[i][0] - ax, py = pixels[i][1] - ay;
      const share = length > 0 ? Math.min(Math.max((px * dx + py * dy) / length, 0), 1) : 0;
      off = Math.max(off, Math.hypot(px - share * dx, py - share * dy));
    }
  }
  return { off, drawn };
});

// Six stretches round a circle, of which the picture has one side: of the others no more than their ends are drawn, and
// nothing that joins two points crosses the picture.
async function whatIsOutsideThePictureIsLeftOut({ page }) {
  const drawn = await page.evaluate(() => {
    const { camera, trail } = meridian.view;
    const kStretch = 4096, kCount = 6 * kStretch, kRadius = 100;
    const line = new trail.line.constructor(kCount), points = new Float32Array(3 * kCount);
    for (let i = 0; i < kCount; ++i) {
      const angle = (2 * Math.PI * i) / kCount, radius = kRadius + (i % 2);
      points.set([radius * Math.cos(angle), radius * Math.sin(angle), 0], 3 * i);
    }
    line.set(points, new Uint8Array(3 * kCount));
    const eye = camera.clone();
    const from = (x, height) => {
      eye.position.set(x, 0, height);
      eye.up.set(0, 1, 0);
      eye.lookAt(x, 0, 0);
      eye.updateMatrixWorld();
      line.setDetail(eye, 1e-6);
      const at = (k) => points.subarray(3 * line.index.array[k], 3 * line.index.array[k] + 2);
      let longest = 0;
      for (let k = 1; k < line.drawn; ++k) {
        const [ax, ay] = at(k - 1), [bx, by] = at(k), isSeen = Math.max(ax, bx) > 10;
        if (isSeen) longest = Math.max(longest, Math.hypot(bx - ax, by - ay));
      }
      return { count: line.drawn, longest };
    };
    return { near: from(70, 130), far: from(0, 45000), again: from(70, 130), kCount };
  });
  must(drawn.near.count < 0.6 * drawn.kCount && drawn.again.count === drawn.near.count, JSON.stringify(drawn));
  must(drawn.near.longest < 110 && drawn.far.count === drawn.kCount, JSON.stringify(drawn));
}

// A turn where a processor draws takes fewer pixels and no edges that are smoothed; at rest both come back.
async function aTurnIsDrawnPlainlyAndItsEndIsSmooth({ page }) {
  const seen = await page.evaluate(async () => {
    const { view } = meridian, smooth = view.smoothEdges.constructor.prototype, own = smooth.draw;
    let smoothed = 0;
    view.smoothEdges.draw = (...words) => (++smoothed, own.apply(view.smoothEdges, words));
    const pictures = (count) => new Promise((done) => {
      const next = () => (count-- > 0 ? (view.controls.dispatchEvent({ type: "change" }), requestAnimationFrame(next)) : done());
      next();
    });
    await pictures(4);
    const turning = { smoothed, width: view.canvas.width };
    await new Promise((done) => setTimeout(done, 1500));
    const rest = { smoothed, width: view.canvas.width };
    delete view.smoothEdges.draw;
    return { turning, rest, isSlow: view.isSlow, samples: view.smoothEdges.target.samples, width: view.canvas.clientWidth };
  });
  must(seen.isSlow && seen.samples === 4, `the browser draws in software: ${JSON.stringify(seen)}`);
  must(seen.turning.smoothed === 0 && seen.turning.width < 0.6 * seen.width, JSON.stringify(seen));
  must(seen.rest.smoothed > 0 && seen.rest.width === seen.width, JSON.stringify(seen));
}

async function aHiddenTabKeepsNoListOfNews({ page }) {
  const ranges = await page.evaluate(() => {
    const Line = meridian.view.trail.line.constructor, line = new Line(8192);
    for (let i = 0; i < 5000; ++i) line.add([i, 0, 0], [1, 2, 3]);
    const { array, updateRanges } = line.index;
    return { count: updateRanges.length, end: Math.max(...updateRanges.map((one) => one.start + one.count)), drawn: line.drawn, last: array[4999] };
  });
  must(ranges.count <= 256 && ranges.end === 5000 && ranges.drawn === 5000 && ranges.last === 4999, JSON.stringify(ranges));
}

// A body from a file takes the place of what was drawn of its link, and stands beside the part.
async function aMeshTakesThePlaceOfItsLink({ page }) {
  const corners = await page.evaluate(() => {
    const { machine } = meridian.view, { faces } = machine.bodies;
    const { constructor: Geometry, attributes: { position: { constructor: Attribute } } } = faces.geometry;
    const count = () => faces.geometry.attributes.position.count;
    const triangle = () => {
      const geometry = new Geometry();
      for (const name of ["position", "normal"]) geometry.setAttribute(name, new Attribute(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]), 3));
      return geometry;
    };
    const plain = count();
    machine.addMesh("part", triangle());
    const withPart = count();
    machine.addMesh(machine.scene.joints.at(-1).name, triangle());
    return { plain, withPart, withLink: count(), tool: machine.tool.parent !== null };
  });
  must(corners.withPart === corners.plain + 3 && corners.withLink < corners.plain && corners.tool, JSON.stringify(corners));
}

// What this browser draws of a page with a WebGL canvas of that size that it only clears: the host's share of the figure.
async function emptyCanvas(browser, { width, height }) {
  const page = await (await browser.newContext({ viewport: kLarge })).newPage();
  await page.setContent(`<body style="margin:0;background:#123"><canvas width="${width}" height="${height}"></canvas>`);
  const rate = await page.evaluate(async () => {
    const gl = document.querySelector("canvas").getContext("webgl2", { antialias: true });
    const begin = performance.now();
    for (let drawn = 0; ; ++drawn) {
      const now = await new Promise((done) => requestAnimationFrame(done));
      if (now - begin > 3000) return (1000 * drawn) / (now - begin);
      gl.clearColor((drawn % 60) / 60, 0.2, 0.3, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    }
  });
  await page.context().close();
  return rate;
}

async function aLongPathTurns({ page, browser }) {
  await page.setViewportSize(kLarge);
  await enabled(page);
  const empty = await framesPerSecond(page, 3);
  await page.click("#tab-program");
  await page.setInputFiles("#program-file", longProgram());
  await phase(page, "ready", 900000);
  must((await page.evaluate(() => meridian.program.program.reason)) === "", "the program is refused");
  await until("the path", () => page.evaluate(() => meridian.view.path?.line.count > 0), 60000);
  await page.click("#tab-machine");
  await page.click('[data-view="part"]');
  await sleep(1000);
  const { off, drawn } = await leftOut(page);
  const points = await page.evaluate(() => meridian.program.path.count);
  console.log(`  ${drawn} of ${points} points are drawn, the others lie ${off.toFixed(3)} pixels off`);
  must(drawn < 0.7 * points && off < 0.6, "the line is not drawn as finely as it is seen");
  const used = cpuSecondsOf(plant.panel.pid), began = Date.now();
  const full = await framesPerSecond(page, 5);
  const share = (cpuSecondsOf(plant.panel.pid) - used) / ((Date.now() - began) / 1000);
  const canvas = await page.evaluate(() => ({ width: meridian.view.canvas.width, height: meridian.view.canvas.height }));
  const bare = await emptyCanvas(browser, canvas);
  console.log(`  ${kBlocks} blocks, ${points} points: ${full.toFixed(1)} frames/s at 1080p, ${empty.toFixed(1)} without, ${bare.toFixed(1)} of a bare canvas of ${canvas.width} x ${canvas.height}; panel ${(100 * share).toFixed(1)} % of a core, ${memoryOf(plant.panel.pid)} KiB`);
  must(full >= kMinFrames, `${full} frames/s`);
  must(full > 0.5 * empty, "the path takes more than half of the frames");
}

await runTests(plant, pictures, async (session, run) => {
  await plant.start();
  await run("ThePageIsSmall", thePageIsSmall);
  session.open = await openBrowser(playwright, plant, { isEachFrameDrawn: true });
  await run("TheFirstPictureComesSoon", theFirstPictureComesSoon, session.open);
  await run("WhatIsOutsideThePictureIsLeftOut", whatIsOutsideThePictureIsLeftOut, session.open);
  await run("ATurnIsDrawnPlainlyAndItsEndIsSmooth", aTurnIsDrawnPlainlyAndItsEndIsSmooth, session.open);
  await run("AHiddenTabKeepsNoListOfNews", aHiddenTabKeepsNoListOfNews, session.open);
  await run("AMeshTakesThePlaceOfItsLink", aMeshTakesThePlaceOfItsLink, session.open);
  await run("ALongPathTurns", aLongPathTurns, session.open);
});
