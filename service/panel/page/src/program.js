// SPDX-License-Identifier: Apache-2.0
// A program: dropped, checked, shown, loaded. Loading moves nothing; Start does.
import { byId, element, setText } from "./dom.js";
import { legendRows } from "./legend.js";
import { Listing } from "./listing.js";
import { heldName } from "./held.js";
import { kOnlyWatches } from "./operate.js";
import { Path } from "./picture/path.js";
import { PlanOffset } from "./plan_offset.js";
import { ProgramPath } from "./program_path.js";
import { clock, fixed, shown, unit } from "./units.js";

const kPhases = {
  none: ["", ""], checking: ["checking", "busy"], refused: ["does not fit", "bad"], ready: ["checked", "good"], streaming: ["loaded", "good"],
};

const kTries = 30, kAgain_ms = 500;

export class Program {
  constructor(panel) {
    this.panel = panel;
    this.listing = new Listing(byId("program-text"));
    this.program = { phase: "none", findings: [] };
    this.wireButtons();
    this.wireDrops();
  }

  wireButtons() {
    const file = byId("program-file");
    byId("program-choose").addEventListener("click", () => file.click());
    file.addEventListener("change", () => {
      if (file.files[0]) this.send(file.files[0]);
      file.value = "";
    });
    const { operate } = this.panel;
    byId("program-check").addEventListener("click", () =>
      operate.request({ do: "check", line: Math.max(0, Math.round(Number(byId("program-line").value) || 0)) }));
    byId("program-load").addEventListener("click", () => operate.request({ do: "load" }));
    byId("program-unload").addEventListener("click", () => operate.request({ do: "unload" }));
  }

  wireDrops() {
    const show = (isShown) => (byId("drop").hidden = !isShown || this.panel.operate.isWatching);
    const hasFile = (event) => event.dataTransfer?.types.includes("Files");
    window.addEventListener("dragover", (event) => {
      if (!hasFile(event)) return;
      event.preventDefault();
      show(true);
    });
    window.addEventListener("dragleave", (event) => event.relatedTarget === null && show(false));
    window.addEventListener("drop", (event) => {
      if (!hasFile(event)) return;
      event.preventDefault();
      show(false);
      this.take([...event.dataTransfer.files]);
    });
  }

  // Which of several is meant, nobody can know.
  take(files) {
    if (files.length === 1) return this.send(files[0]);
    return this.panel.operate.report(false, files.length === 0 ? "that is no file" : `${files.length} files at once: drop the one program that is meant`);
  }

  setOperator({ who, key }) {
    this.key = key;
    if (who === "watching") setText(byId("program-hint"), `${kOnlyWatches} Programs are checked and loaded on one that operates.`);
  }

  async send(file) {
    const { operate, tabs } = this.panel;
    if (operate.isWatching) return operate.report(false, `${kOnlyWatches} The program was not sent.`);
    tabs.show("tab-program");
    byId("program-line").value = "0";
    try {
      const answer = await fetch(`/program?key=${this.key}&name=${encodeURIComponent(file.name)}`, { method: "POST", body: file });
      operate.report(answer.ok, await answer.text());
    } catch {
      operate.report(false, "the panel does not answer: the program was not sent");
    }
    return undefined;
  }

  // ---- what the panel's process says of it

  setProgram(program) {
    const isOther = program.name !== this.program.name || program.phase === "checking";
    this.program = program;
    const [word, kind] = kPhases[program.phase];
    setText(byId("program-name"), program.name || "No program");
    setText(byId("program-phase"), program.simulating ? "checked, simulating" : word);
    byId("program-phase").className = `badge ${kind}`;
    setText(byId("program-message"), program.message || program.reason);
    setText(byId("program-placing"), program.placing);
    byId("program-hint").hidden = program.phase !== "none";
    if (isOther) this.listing.clear();
    this.drawTimes();
    this.drawFindings();
    this.fetchPath();
    this.setButtons();
    if (program.phase === "ready" || program.phase === "refused") this.listing.show(this.listing.line || this.firstLine());
  }

  firstLine() {
    return this.program.findings.find((one) => one.refusal)?.line || Math.max(1, this.program.first_line);
  }

  setButtons() {
    const may = this.panel.operate.isOperator && this.panel.frame !== null;
    const { phase } = this.program;
    byId("program-choose").disabled = !may || phase === "streaming";
    byId("program-check").disabled = !may || !["ready", "refused"].includes(phase);
    byId("program-load").disabled = !may || phase !== "ready" || this.panel.frame.session;
    byId("program-unload").disabled = !may || phase !== "streaming";
  }

  drawTimes() {
    const { program } = this;
    const box = byId("program-times");
    box.hidden = !["ready", "streaming"].includes(program.phase);
    const fact = (name, value) => element("div", {}, element("span", {}, name), element("b", {}, value));
    const facts = [fact("blocks", String(program.blocks)), fact("lines", String(program.lines))];
    if (program.has_run) {
      facts.push(fact("program", clock(program.program_s)), fact("approach", clock(program.approach_s)), fact("waits", clock(program.waiting_s)));
    } else {
      facts.push(fact("at programmed feeds", clock(program.at_feed_s)));
    }
    box.replaceChildren(...facts);
  }

  drawFindings() {
    const rows = this.program.findings.map((one) => {
      const count = one.count > 1 ? ` (${one.count} places, first here)` : "";
      const words = element("span", {}, `${one.message}${count}`);
      if (one.remedy) words.append(element("small", {}, one.remedy));
      const button = element("button", { type: "button" }, element("b", {}, one.line > 0 ? `line ${one.line}` : "file"), words);
      button.addEventListener("click", () => this.listing.show(one.line));
      return element("li", { class: one.refusal ? "refusal" : "warning" }, button);
    });
    byId("program-findings").replaceChildren(...rows);
  }

  async fetchPath() {
    const number = this.program.path;
    if (number === this.shownPath) return;
    this.shownPath = number;
    this.path = null;
    this.panel.view.setPath(null);
    byId("program-limits").replaceChildren();
    const bytes = number === 0 ? null : await this.bytesOfPath(number);
    if (!bytes || number !== this.shownPath) return;
    this.path = new ProgramPath(bytes);
    this.panel.view.setPath(new Path(this.path));
    this.drawLimits();
  }

  // Asked for again where they do not come; nothing where another path is shown meanwhile.
  async bytesOfPath(number) {
    for (let i = 0; i < kTries && number === this.shownPath; ++i) {
      try {
        const answer = await fetch(`/program/path?number=${number}`);
        if (answer.ok) return await answer.arrayBuffer();
      } catch {
        // The link says that the panel is gone.
      }
      await new Promise((done) => setTimeout(done, kAgain_ms));
    }
    return null;
  }

  drawLimits() {
    byId("program-limits").replaceChildren(...legendRows(this.path.byHeld().slice(0, 8), this.path.duration, this.program.limits));
  }

  // A point of the path that was clicked.
  pick(i) {
    const { path, program } = this;
    const held = path.held[i] > 0 ? `, held by ${heldName(path.held[i], program.limits)}` : "";
    const programmed = path.programmed[i] > 0 ? ` of ${fixed(path.programmed[i], 0)}` : "";
    const { joints } = this.panel.view.description;
    const values = path.joints(i, joints.length);
    const where = joints.map((joint, k) => `${joint.name} ${fixed(shown(joint, values[k]), 3)} ${unit(joint)}`).join(", ");
    setText(byId("picked"), `line ${path.line[i]}, block ${path.block[i]}: ${fixed(path.feed[i], 0)}${programmed} mm/min${held}, ${clock(path.time[i])} into the program; ${where}`);
    this.listing.show(path.line[i]);
  }

  // ---- what the machine says

  isRunning(frame) {
    return frame.session && frame.program === this.program.name && frame.station === this.program.station;
  }

  setFrame(frame) {
    this.setButtons();
    const isOurs = this.isRunning(frame);
    if (isOurs && frame.line > 0) this.listing.show(frame.line);
    const isOnPath = isOurs && this.path && frame.plan_time_s > 0;
    if (!isOnPath) this.offset = null;
    else if (this.offset?.path !== this.path) this.offset = new PlanOffset(this.path);
    this.offset?.see(frame);
    setText(byId("block-to-go"), isOnPath ? `${fixed(this.path.distanceToGo(this.planTime(frame), frame.line, frame.tip), 1)} mm` : "\u2013");
    setText(byId("to-go"), isOnPath ? `to go ${clock(this.toGo(frame))}` : "");
  }

  // Where the simulated plan is when the machine's is where the frame says.
  planTime(frame) {
    return frame.plan_time_s - (this.offset?.value ?? 0);
  }

  // An override below 100 % stretches what is left.
  toGo(frame) {
    const rate = Math.min(frame.feed_override, 1);
    return rate > 0 ? this.path.toGo(this.planTime(frame)) / rate : Infinity;
  }
}
