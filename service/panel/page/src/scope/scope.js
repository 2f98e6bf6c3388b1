// SPDX-License-Identifier: Apache-2.0
// The joints as on an oscilloscope: two plots over one time, at the rate of the wire, live or of a recording.
import uPlot from "uplot";
import { byId, element, setText } from "../dom.js";
import { jointColour } from "../held.js";
import { kMaxBytes, readRecording } from "./recording.js";
import { kQuantities, ScopeBuffer } from "./scope_buffer.js";
import { mcapOf } from "./scope_mcap.js";
import { readoutOf } from "./scope_readout.js";
import { ScopeState } from "./scope_state.js";
import { Trigger } from "./trigger.js";
import { fixed, unit } from "../units.js";

const kBetweenDrawings_ms = 100;
const kPlots = ["scope-plot-1", "scope-plot-2"];
const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export class Scope {
  constructor(panel) {
    this.panel = panel;
    this.state = new ScopeState();
    this.trigger = new Trigger();
    this.cursors = [null, null];
    this.zoom = null;
    this.drawn = 0;
    for (const id of ["scope-quantity-1", "scope-quantity-2"]) {
      byId(id).append(...Object.entries(kQuantities).map(([value, { label }]) => element("option", { value }, label)));
      byId(id).addEventListener("change", () => this.rebuild());
    }
    byId("scope-quantity-1").value = "velocity";
    byId("scope-quantity-2").value = "following";
    byId("scope-window").addEventListener("change", () => this.draw());
    byId("scope-pause").addEventListener("click", () => this.change(this.state.isFollowing ? "pause" : "go"));
    byId("scope-arm").addEventListener("click", () => this.arm());
    byId("scope-csv").addEventListener("click", () => this.save("csv", new Blob([this.buffer.csv(...this.range())], { type: "text/csv" })));
    byId("scope-mcap").addEventListener("click", async () => this.save("mcap", await mcapOf(this.buffer, ...this.range())));
    byId("scope-live").addEventListener("click", () => this.change("go"));
    const file = byId("scope-file");
    byId("scope-open").addEventListener("click", () => file.click());
    file.addEventListener("change", () => {
      if (file.files[0]) this.open(file.files[0]);
      file.value = "";
    });
    window.addEventListener("meridian-view", () => this.resize());
    new ResizeObserver(() => this.resize()).observe(byId("sheet-scope"));
  }

  // A machine with the same joints stands elsewhere, or has other limits: what is shown stays. `scene`: null where the
  // joints are not known any more; then nothing is shown.
  setMachine(scene) {
    if (!scene) return this.clear();
    const shapeOf = (one) => JSON.stringify([one?.joints.map(({ name, rotary }) => [name, rotary]), one?.cycle_s]);
    const isSame = shapeOf(scene) === shapeOf(this.scene);
    this.scene = scene;
    if (isSame) return undefined;
    this.live = new ScopeBuffer(scene.joints, scene.cycle_s);
    this.chosen = scene.joints.map((_, i) => i);
    const toggles = scene.joints.map((joint, i) => {
      const button = element("button", { type: "button", "aria-pressed": "true" }, joint.name);
      button.style.setProperty("--dot", jointColour(i));
      button.addEventListener("click", () => {
        const isOn = button.getAttribute("aria-pressed") !== "true";
        button.setAttribute("aria-pressed", String(isOn));
        this.chosen = scene.joints.map((_, k) => k).filter((k) => toggles[k].getAttribute("aria-pressed") === "true");
        this.rebuild();
      });
      return button;
    });
    byId("scope-joints").replaceChildren(...toggles);
    byId("scope-state").replaceChildren(...["Running", "Holding", "Held", "Starving", "FaultStop", "Fault", "Ready"].map((value) => element("option", { value }, value)));
    this.change("go");
    return this.showLive();
  }

  clear() {
    for (const plot of this.plots ?? []) plot.destroy();
    this.scene = this.live = this.buffer = this.plots = null;
    byId("scope-joints").replaceChildren();
  }

  // ---- what comes in

  setFrame(frame) {
    if (!this.live) return;
    if (frame.service !== this.service) this.beginAnew(frame.service);
    const count = this.scene.joints.length;
    const before = this.live.added;
    for (const row of frame.samples) {
      this.live.add(row[0], row.slice(1, 1 + count), row.slice(1 + count, 1 + 2 * count), row[1 + 2 * count]);
    }
    const first = Math.max(0, this.live.count - (this.live.added - before));
    this.trigger.look(frame, this.live, first);
    this.stopWhereTriggered();
    const now = performance.now();
    if (!this.state.isFollowing || now - this.drawn < kBetweenDrawings_ms) return;
    this.drawn = now;
    this.draw();
  }

  // Another service counts its own cycles. What stands still is still that of the one before.
  beginAnew(service) {
    this.service = service;
    if (this.state.now === "armed" && !this.fireWhereTriggered()) this.trigger.armAgain();
    this.live = new ScopeBuffer(this.scene.joints, this.scene.cycle_s);
    if (this.state.isFollowing) this.showLive();
  }

  stopWhereTriggered() {
    if (this.state.now === "armed" && this.live.end >= this.trigger.at + this.window / 2) this.fireWhereTriggered();
  }

  // Whether the trigger had fired.
  fireWhereTriggered() {
    const { at } = this.trigger;
    if (at === null) return false;
    this.change("fire");
    this.report(`triggered at ${fixed(at, 3)} s`);
    return true;
  }

  get window() {
    return Number(byId("scope-window").value);
  }

  // ---- what the operator asks for

  // All that goes with a change of the state.
  change(event) {
    if (!this.state.take(event)) return;
    const { now, isFollowing } = this.state;
    this.zoom = null;
    if (isFollowing) this.cursors = [null, null];
    if (now !== "armed" && now !== "triggered") this.trigger.disarm();
    byId("scope-pause").setAttribute("aria-pressed", String(!isFollowing));
    setText(byId("scope-pause"), isFollowing ? "Pause" : "Go on");
    byId("scope-live").hidden = now !== "file";
    this.report(now === "armed" ? "armed" : "");
    if (isFollowing && this.buffer !== this.live) this.showLive();
    this.frozenEnd = this.buffer?.end ?? 0;
    this.draw();
  }

  showLive() {
    this.buffer = this.live;
    this.offerQuantities();
  }

  arm() {
    const kind = byId("scope-trigger").value;
    if (kind === "none") return this.change("go");
    this.change("arm");
    const quantity = byId("scope-quantity-1").value;
    this.trigger.arm(kind, kind === "state" ? byId("scope-state").value
      : { quantity, joint: this.chosen[0] ?? 0, level: Number(byId("scope-level").value) || 0 });
    return undefined;
  }

  // What the wire does not carry is offered of recordings alone.
  offerQuantities() {
    const isLive = this.state.now !== "file";
    for (const id of ["scope-quantity-1", "scope-quantity-2"]) {
      for (const option of byId(id).options) option.hidden = option.disabled = isLive && kQuantities[option.value].isRecorded === true;
      if (byId(id).selectedOptions[0].disabled) byId(id).value = "feed";
    }
    this.rebuild();
  }

  async open(file) {
    if (!this.scene) return this.report("no machine is known whose joints a recording could name");
    if (file.size > kMaxBytes) return this.report("the recording has more than 96 MiB: cut it, or use meridian check --html");
    try {
      this.show(readRecording(await file.text(), this.scene.joints, this.scene.cycle_s), file.name);
    } catch (error) {
      this.report(error.message);
    }
    return undefined;
  }

  show({ buffer, cut }, name) {
    this.buffer = buffer;
    this.change("open");
    this.offerQuantities();
    const words = cut > 0 ? `, ${cut} ${cut === 1 ? "row is" : "rows are"} cut off and left out` : "";
    this.report(`${name}: ${buffer.count} cycles${words}`);
  }

  save(kind, blob) {
    const link = element("a", { href: URL.createObjectURL(blob), download: `meridian-scope.${kind}` });
    link.click();
    URL.revokeObjectURL(link.href);
  }

  report(text) {
    setText(byId("scope-report"), text);
  }

  // ---- drawing

  // What is shown, s: the newest window; of a recording, or after a zoom, what the plots show.
  range() {
    const { buffer } = this;
    if (this.zoom) return this.zoom;
    if (this.state.now === "file") return [buffer.time(0), buffer.end];
    const end = this.state.isFollowing ? buffer.end : this.frozenEnd;
    const centre = this.trigger.at;
    if (this.state.now === "triggered") return [centre - this.window / 2, centre + this.window / 2];
    return [end - this.window, end];
  }

  rebuild() {
    if (!this.buffer) return;
    for (const plot of this.plots ?? []) plot.destroy();
    this.plots = kPlots.map((id, i) => this.plot(byId(id), byId(`scope-quantity-${i + 1}`).value));
    this.draw();
  }

  plot(box, quantity) {
    const { perJoint, label } = kQuantities[quantity];
    const axis = { stroke: () => style("--soft"), grid: { stroke: () => style("--line"), width: 1 }, ticks: { show: false }, font: "12px sans-serif" };
    const series = perJoint
      ? this.chosen.map((k) => ({ label: this.scene.joints[k].name, stroke: jointColour(k), width: 1.4, value: (_, v) => (v === null ? "" : `${v.toPrecision(5)} ${unit(this.scene.joints[k])}`) }))
      : [{ label, stroke: style("--accent"), width: 1.4 }];
    return new uPlot({
      width: Math.max(box.clientWidth, 100), height: Math.max(box.clientHeight - 34, 80), title: "",
      cursor: { sync: { key: "scope" }, drag: { x: true, y: false, setScale: false } }, legend: { live: true },
      scales: { x: { time: false, range: () => this.range() }, y: {} },
      axes: [axis, { ...axis, size: 66, label, labelSize: 20, labelFont: "13px sans-serif" }],
      series: [{ label: "s", value: (_, v) => (v === null ? "" : fixed(v, 4)) }, ...series],
      hooks: {
        draw: [(plot) => this.drawMarks(plot)],
        setSelect: [(plot) => this.select(plot)],
        ready: [(plot) => {
          plot.over.addEventListener("click", (event) => event.detail < 2 && this.click(plot));
          plot.over.addEventListener("dblclick", () => this.showAll());
        }],
      },
    }, [[], ...series.map(() => [])], box);
  }

  draw() {
    if (!this.plots || byId("sheet-scope").hidden || !this.buffer) return;
    const [begin, end] = this.range();
    this.plots.forEach((plot, i) => plot.setData(this.buffer.rows(byId(`scope-quantity-${i + 1}`).value, this.chosen, begin, end)));
    this.drawReadout();
  }

  resize() {
    for (const plot of this.plots ?? []) {
      const box = plot.root.parentElement;
      if (box.clientWidth > 0) plot.setSize({ width: box.clientWidth, height: Math.max(box.clientHeight - 34, 80) });
    }
    this.draw();
  }

  // A stretch that was dragged over is shown alone; a double click shows all again.
  select(plot) {
    if (plot && plot.select.width < 4) return;
    const zoom = plot ? [plot.posToVal(plot.select.left, "x"), plot.posToVal(plot.select.left + plot.select.width, "x")] : null;
    if (plot) {
      plot.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
      this.change("pause");
    }
    this.zoom = zoom;
    this.draw();
  }

  // The first click of a double one set a cursor: that is taken back.
  showAll() {
    const { state, cursors } = this.beforeClick ?? {};
    this.beforeClick = null;
    if (state === "running") this.change("go");
    else if (state === "armed") this.arm();
    else if (cursors) this.cursors = cursors;
    this.select(null);
  }

  click(plot) {
    this.beforeClick = null;
    if (plot.select.width < 4) this.setCursor(plot);
  }

  // Cursor A, then B, then A again.
  setCursor(plot) {
    if (plot.cursor.left < 0) return;
    const at = plot.posToVal(plot.cursor.left, "x");
    this.beforeClick = { state: this.state.now, cursors: this.cursors };
    this.change("pause");
    this.cursors = this.cursors[0] === null || this.cursors[1] !== null ? [at, null] : [this.cursors[0], at];
    this.draw();
  }

  drawMarks(plot) {
    const { ctx, bbox } = plot;
    const line = (at, colour, name) => {
      if (at === null) return;
      const x = plot.valToPos(at, "x", true);
      if (x < bbox.left || x > bbox.left + bbox.width) return;
      ctx.save();
      ctx.strokeStyle = ctx.fillStyle = colour;
      ctx.lineWidth = 2;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      ctx.font = "bold 13px sans-serif";
      ctx.fillText(name, x + 4, bbox.top + 14);
      ctx.restore();
    };
    line(this.trigger.at, style("--bad"), "T");
    line(this.cursors[0], style("--warn"), "A");
    line(this.cursors[1], style("--warn"), "B");
  }

  drawReadout() {
    const box = byId("scope-readout");
    box.hidden = this.cursors[0] === null;
    if (box.hidden) return;
    const quantities = [1, 2].map((i) => byId(`scope-quantity-${i}`).value);
    box.replaceChildren(...readoutOf(this.buffer, quantities, this.chosen, this.cursors));
  }
}
