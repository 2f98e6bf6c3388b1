// SPDX-License-Identifier: Apache-2.0
// A run that lies in the page itself: scrub through time, see machine, feed and limits at that moment.
import uPlot from "uplot";
import { byId, element, setShare, setText } from "./dom.js";
import { heldAt, heldName, jointColour, timeByHeld } from "./held.js";
import { legendRows } from "./legend.js";
import { Path } from "./picture/path.js";
import { clock, fixed } from "./units.js";

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export class Report {
  constructor(report, view, display) {
    Object.assign(this, { report, view, display, columns: report.columns, at: 0 });
    this.count = this.columns.time.length;
    document.body.classList.add("is-report");
    document.body.dataset.tone = report.findings.length > 0 ? "fault" : "ready";
    setText(byId("state"), report.findings.length > 0 ? `${report.findings.length} findings` : "No findings");
    display.setMachine({ scene: report.scene, name: report.scene.name, host: "report", version: "" });
    setText(byId("host"), "opened from a file, without a machine");
    document.title = report.title;
    setText(byId("program"), report.title);
    setText(byId("station"), `${this.count} samples, ${clock(this.columns.time.at(-1) ?? 0)}`);
    this.held = this.columns.limit.map((limit, i) => heldAt(limit, this.columns.cause[i]));
    this.path = new Path({ ...this.columns, held: this.held });
    view.setMachine(report.scene);
    view.setPath(this.path);
    this.drawWords();
    this.drawLegend();
    this.drawCharts();
    this.wire();
    this.show(0);
  }

  drawWords() {
    const rows = this.report.findings.map((text) => element("li", { class: "alarm" }, element("span", {}, text)));
    if (rows.length === 0) rows.push(element("li", {}, element("span", {}, "Nothing wrong was found.")));
    byId("news").replaceChildren(...rows);
    setText(byId("summary"), this.report.summary);
  }

  drawLegend() {
    const { time } = this.columns;
    byId("legend").replaceChildren(...legendRows(timeByHeld(this.held, time).slice(0, 8), time.at(-1) || 1, this.report.limits));
  }

  chart(id, series, data, top) {
    const box = byId(id);
    const axis = { stroke: () => style("--soft"), grid: { stroke: () => style("--line"), width: 1 }, ticks: { show: false }, font: "12px sans-serif" };
    return new uPlot({
      width: box.clientWidth, height: box.clientHeight - 30, cursor: { sync: { key: "time" }, drag: { x: true, y: false } },
      legend: { show: true, live: false }, scales: { x: { time: false }, y: { range: (_, low, high) => [0, top ?? Math.max(high, 1) * 1.06] } },
      axes: [axis, { ...axis, size: 60 }], series: [{ label: "s" }, ...series],
      hooks: { draw: [(plot) => this.drawCursor(plot)] },
    }, data, box);
  }

  drawCharts() {
    const { time, feed, programmed, shares } = this.columns;
    const joints = this.report.scene.joints;
    this.charts = [
      this.chart("chart-feed", [
        { label: "programmed", stroke: style("--soft"), width: 1, dash: [5, 4] },
        { label: "feed, mm/min", stroke: style("--accent"), width: 1.5 },
      ], [time, programmed.map((value) => (value > 0 ? value : null)), feed]),
      this.chart("chart-shares", joints.map((joint, i) => ({ label: joint.name, stroke: jointColour(i), width: 1.2 })),
        [time, ...joints.map((_, i) => time.map((__, k) => shares[k * joints.length + i]))], 1.1),
    ];
    new ResizeObserver(() => {
      for (const chart of this.charts) {
        const box = chart.root.parentElement;
        chart.setSize({ width: box.clientWidth, height: box.clientHeight - 30 });
      }
    }).observe(byId("chart-feed"));
  }

  drawCursor(plot) {
    const x = plot.valToPos(this.columns.time[this.at], "x", true);
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.strokeStyle = style("--bad");
    ctx.lineWidth = 2;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }

  wire() {
    const scrub = byId("scrub");
    scrub.max = String(this.count - 1);
    scrub.addEventListener("input", () => this.show(Number(scrub.value)));
    byId("play").addEventListener("click", () => this.play(!this.playing));
    for (const chart of this.charts) {
      chart.over.addEventListener("click", () => {
        if (chart.cursor.idx != null) this.show(chart.cursor.idx);
      });
    }
  }

  pick(i) {
    this.show(i);
  }

  play(isPlaying) {
    this.playing = isPlaying;
    setText(byId("play"), isPlaying ? "Pause" : "Play");
    if (!isPlaying) return;
    if (this.at >= this.count - 1) this.show(0);
    const { time } = this.columns;
    const from = time[this.at], begun = performance.now();
    const step = () => {
      if (!this.playing) return;
      const now = from + (performance.now() - begun) / 1000;
      let i = this.at;
      while (i < this.count - 1 && time[i + 1] <= now) i += 1;
      this.show(i);
      if (i >= this.count - 1) this.play(false);
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  // What a frame of a live machine would say at sample `i`.
  show(i) {
    this.at = i;
    const { columns, report } = this;
    const joints = report.scene.joints;
    const slice = (name, width) => columns[name].slice(i * width, (i + 1) * width);
    const q = slice("joints", joints.length), share = slice("shares", joints.length);
    this.view.setJoints(q, columns.tool[i]);
    this.display.setPosition({ tip: slice("tip", 3), axis: slice("axis", 3) });
    this.display.setTool({ tool_length: columns.tool[i] });
    setText(byId("feed"), fixed(columns.feed[i], 0));
    setText(byId("feed-programmed"), columns.programmed[i] > 0 ? `of ${fixed(columns.programmed[i], 0)}` : "");
    setShare(byId("feed-bar"), columns.programmed[i] > 0 ? Math.min(1, columns.feed[i] / columns.programmed[i]) : 0);
    setText(byId("held-by"), this.held[i] === 0 ? "" : `held by: ${heldName(this.held[i], report.limits)}`);
    this.display.setJoints({ joints: q, shares: share.map((value) => [value, 0, 0]), limiting: "" });
    setText(byId("line"), columns.line[i] > 0 ? `line ${columns.line[i]}` : "");
    setText(byId("moment"), `${fixed(columns.time[i], 2)} s`);
    byId("scrub").value = String(i);
    for (const chart of this.charts) chart.redraw(false);
  }
}
