// SPDX-License-Identifier: Apache-2.0
// Position, feed, joints, program, health: what a frame says, in numbers and words.
import { byId, element, setShare, setText } from "./dom.js";
import { clock, fixed, shown, unit } from "./units.js";

const kTones = {
  Off: "off", Enabling: "busy", Ready: "ready", Loaded: "ready", Approaching: "run", Running: "run", Holding: "hold",
  Held: "hold", Starving: "hold", Starved: "hold", Aborting: "busy", Disabling: "busy", FaultStop: "fault", Fault: "fault",
  Jogging: "jog", Homing: "jog", Stepping: "run",
};

// "clockwise 8000 rev/min" as a display has room for: CW 8000/min.
const shortSpindle = (words) =>
  words.replace(/^spindle /, "").replace("counter-clockwise", "CCW").replace("clockwise", "CW").replace(" rev/min", "/min");

// The day stands in front where it is not today.
function shownTime(time_ms) {
  const time = new Date(time_ms);
  const clockTime = time.toLocaleTimeString([], { hourCycle: "h23" });
  return time.toDateString() === new Date().toDateString() ? clockTime : `${time.toLocaleDateString()} ${clockTime}`;
}

const kOrders = ["velocity", "acceleration", "jerk"];

export class Display {
  constructor() {
    byId("news-source").addEventListener("change", () => this.drawNews());
  }

  setMachine(message) {
    this.scene = message.scene;
    setText(byId("machine-name"), message.name);
    setText(byId("host"), `${message.host} \u00b7 Meridian ${message.version}`);
    document.title = `${message.name} \u2013 Meridian`;
    if (this.scene) this.buildJoints();
    else this.clearPosition();
  }

  // Where tip and joints are is not known any more.
  clearPosition() {
    this.rows = null;
    byId("joints").replaceChildren();
    for (const id of ["tip-x", "tip-y", "tip-z", "axis-i", "axis-j", "axis-k"]) setText(byId(id), "\u2013");
  }

  buildJoints() {
    this.rows = this.scene.joints.map((joint, i) => {
      const mark = element("i", { class: "mark" });
      const bar = element("div", { class: joint.endless ? "travel endless" : "travel", role: "presentation" }, mark);
      const value = element("output", { class: "value" });
      const shares = kOrders.map((order) => element("i", { title: `share of the ${order} limit` }));
      const boxes = this.boxesOf(i, joint);
      bar.prepend(...boxes.map((box) => box.strip));
      const row = element("div", { class: "joint" },
        element("b", {}, joint.name), value, element("span", { class: "unit" }, unit(joint)), bar,
        element("div", { class: "shares" }, ...shares.map((share) => element("div", {}, share))));
      return { row, mark, value, shares, boxes, peaks: [0, 0, 0] };
    });
    byId("joints").replaceChildren(...this.rows.map((one) => one.row));
  }

  // Strips of a joint's bar, where keep-out boxes name it.
  boxesOf(i, joint) {
    const [low, high] = joint.soft_limits ?? joint.travel;
    const percent = (value) => 100 * Math.min(Math.max((value - low) / (high - low), 0), 1);
    return this.scene.keep_out.flatMap((box) => {
      const own = box.joints.find((one) => one.joint === i);
      if (!own) return [];
      const strip = element("i", { class: "keep-out", title: `keep-out box ${box.name}` });
      strip.style.left = `${percent(own.min)}%`;
      strip.style.width = `${percent(own.max) - percent(own.min)}%`;
      return [{ strip, others: box.joints.filter((one) => one.joint !== i) }];
    });
  }

  setFrame(frame) {
    this.frame = frame;
    document.body.dataset.tone = kTones[frame.state] ?? "off";
    setText(byId("state"), frame.state === "FaultStop" ? "Fault stop" : frame.state);
    if (frame.joints) {
      this.setPosition(frame);
      this.setJoints(frame);
    }
    this.setTool(frame);
    this.setFeed(frame);
    this.setProgram(frame);
    this.setHealth(frame);
    const alarm = byId("alarm");
    alarm.hidden = !frame.alarm;
    if (frame.alarm) setText(byId("alarm-text"), frame.alarm.text);
  }

  setPosition(frame) {
    ["x", "y", "z"].forEach((name, i) => setText(byId(`tip-${name}`), fixed(frame.tip[i], 3)));
    ["i", "j", "k"].forEach((name, i) => setText(byId(`axis-${name}`), fixed(frame.axis[i], 4)));
  }

  setTool(frame) {
    setText(byId("tool-length"), `${frame.tool > 0 ? `${frame.tool}, ` : ""}${fixed(frame.tool_length, 3)} mm`);
    setText(byId("work-frame"), frame.work_frame > 0 ? String(frame.work_frame) : "machine file");
  }

  setFeed(frame) {
    setText(byId("feed"), fixed(frame.feed_achieved, 0));
    const isRapid = frame.motion === "rapid";
    const programmed = frame.feed_programmed > 0 ? `of ${fixed(frame.feed_programmed, 0)}` : isRapid ? "rapid" : "";
    setText(byId("feed-programmed"), programmed);
    const wanted = frame.feed_programmed * frame.feed_override;
    const share = wanted > 0 ? Math.min(frame.feed_achieved / wanted, 1) : 0;
    setShare(byId("feed-bar"), share);
    setText(byId("held-by"), this.heldBy(frame, wanted));
    setText(byId("override"), `${fixed(100 * frame.feed_override, 0)} %`);
    setText(byId("spindle"), shortSpindle(frame.spindle) || "\u2013");
    setText(byId("coolant"), frame.coolant.replace(/^coolant /, "") || "\u2013");
    setText(byId("rapid-override"), `${fixed(100 * frame.rapid_override, 0)} %`);
  }

  heldBy(frame, wanted) {
    const words = {
      Off: "drives are off", Ready: "ready", Loaded: "program loaded: start when the approach is clear",
      Held: "held: resume goes on", Stepping: "at rest after a block: resume goes on", Holding: "braking for the hold", Starved: "waits for blocks",
      Starving: "blocks do not come fast enough", Fault: "fault: reset after the cause is gone", FaultStop: "stopping",
      Enabling: "drives are switched on", Jogging: "jogging", Homing: "homing", Approaching: "approaches the program",
    };
    if (frame.waits_for) return `waits for: ${frame.waits_for}`;
    if (words[frame.state] && frame.state !== "Approaching") return words[frame.state];
    if (frame.at_pole) return "the axis is on the pole: the redundant joint turns";
    if (frame.limiting) return `joint ${frame.limiting} holds the feed back`;
    if (frame.feed_override < 1 && wanted > 0 && frame.feed_achieved > 0.97 * wanted) return "the override";
    if (wanted > 0 && frame.feed_achieved > 0.97 * wanted) return "feed as programmed";
    if (frame.motion === "rapid") return "rapid";
    return words[frame.state] ?? "accelerates or brakes";
  }

  setJoints(frame) {
    if (!this.rows) return;
    this.rows.forEach((one, i) => {
      const joint = this.scene.joints[i];
      const value = frame.joints[i];
      setText(one.value, fixed(shown(joint, value), joint.rotary ? 4 : 3));
      const [low, high] = joint.endless ? [-Math.PI, Math.PI] : joint.soft_limits ?? joint.travel;
      const turned = joint.endless ? Math.atan2(Math.sin(value), Math.cos(value)) : value;
      const at = Math.min(Math.max((turned - low) / (high - low), 0), 1);
      one.mark.style.left = `${100 * at}%`;
      one.row.classList.toggle("near-end", !joint.endless && (at < 0.03 || at > 0.97));
      for (const { strip, others } of one.boxes) {
        const isClosed = others.every(({ joint: k, min, max }) => frame.joints[k] > min && frame.joints[k] < max);
        strip.classList.toggle("closed", isClosed);
      }
      one.row.classList.toggle("limits", frame.limiting === joint.name);
      frame.shares[i].forEach((share, order) => {
        // Peaks stay for a moment, as an eye needs them.
        one.peaks[order] = Math.max(share, 0.9 * one.peaks[order]);
        setShare(one.shares[order], Math.min(one.peaks[order], 1));
        one.shares[order].classList.toggle("high", one.peaks[order] > 0.97);
      });
    });
  }

  setProgram(frame) {
    const hasProgram = frame.session;
    setText(byId("program"), hasProgram ? frame.program : "no program");
    setText(byId("station"), hasProgram ? `from ${frame.station}` : "");
    const share = frame.block_count > 0 && hasProgram ? Math.min(frame.block / frame.block_count, 1) : 0;
    setShare(byId("progress-bar"), share);
    setText(byId("line"), frame.line > 0 ? `line ${frame.line}` : "");
    setText(byId("block"), hasProgram && frame.block_count > 0 ? `block ${frame.block} of ${frame.block_count}` : "");
    setText(byId("elapsed"), hasProgram && frame.plan_time_s > 0 ? clock(frame.plan_time_s) : "");
    setText(byId("buffer"), `${fixed(frame.planned_s, 1)} s planned \u00b7 ${frame.blocks_queued} blocks wait`);
    setShare(byId("buffer-bar"), Math.min(frame.planned_s / 2, 1));
    const modes = [];
    if (frame.dry_run) modes.push("dry run: no drive moves");
    if (frame.single_block) modes.push("single block");
    if (frame.optional_stop) modes.push("optional stop");
    if (frame.auxiliary_ignored) modes.push("actions are ignored");
    if (frame.enabling_required) modes.push(`enabling: ${frame.enabling_devices} pressed`);
    if (frame.guard_open) modes.push("guard open: jog only");
    setText(byId("modes"), modes.join(" \u00b7 "));
  }

  setHealth(frame) {
    const words = [frame.realtime ? "real time" : "best effort"];
    words.push(frame.secured ? "secured" : frame.open_network ? "OPEN NETWORK" : "this host only");
    words.push(`${frame.periods_lost} of ${frame.cycles} periods lost`);
    if (frame.starvations > 0) words.push(`starved ${frame.starvations} times`);
    if (frame.stalled) words.push(`stalled: ${frame.stalled}`);
    setText(byId("health"), words.join(" \u00b7 "));
  }

  setNews(items) {
    this.news = items;
    this.drawNews();
  }

  // Of all, or of one who speaks: the machine, operators, stations.
  drawNews() {
    const from = byId("news-source").value;
    const rows = (this.news ?? []).filter((item) => from === "all" || item.source === from).reverse().map((item) =>
      element("li", { class: `${["news", "warning", "alarm"][item.severity]} ${item.source}` },
        element("time", { datetime: new Date(item.time_ms).toISOString() }, shownTime(item.time_ms)), element("span", {}, item.text)));
    byId("news").replaceChildren(...rows);
  }

  setLatency(stages) {
    const wake = stages.find((stage) => stage.name.includes("wake")) ?? stages[0];
    if (wake) setText(byId("latency"), `${wake.name}: p99 ${fixed(wake.p99, 0)} \u00b5s, max ${fixed(wake.max, 0)} \u00b5s`);
  }

  setSilent(text) {
    document.body.dataset.tone = "silent";
    setText(byId("state"), text);
  }
}
