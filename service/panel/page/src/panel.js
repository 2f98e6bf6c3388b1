// SPDX-License-Identifier: Apache-2.0
import { byId } from "./dom.js";
import { Actions } from "./actions.js";
import { Display } from "./display.js";
import { Jog } from "./jog.js";
import { Link } from "./link.js";
import { NoView } from "./picture/no_view.js";
import { Operate } from "./operate.js";
import { Program } from "./program.js";
import { Report } from "./report.js";
import { Scope } from "./scope/scope.js";
import { Tabs } from "./tabs.js";
import { Theme } from "./theme.js";
import { Timing } from "./timing.js";
import { canDraw, View } from "./picture/view.js";

// A file that was opened from a disk has its run in itself, and no machine.
const embedded = document.getElementById("report");

// First of all: the answer comes while the rest is made.
const link = embedded ? null : new Link((message) => receive[message.t]?.(message), (isOpen) => isOpen || setSilent("No link"));
const display = new Display();
const view = makeView();
const panel = { link, display, view, frame: null, sequence: 0 };
window.meridian = panel;

// ---- the picture
function makeView() {
  let reason = "This browser has no WebGL, which the picture takes.";
  try {
    if (canDraw(byId("picture"))) return new View(byId("picture"), pick);
  } catch (error) {
    console.error(error);
    reason = `The picture failed: ${error.message}.`;
  }
  explainNoPicture(`${reason} All else on this page works.`);
  return new NoView();
}

function pick(hit) {
  if (hit?.isPath) return (panel.report ?? panel.program).pick(hit.index);
  const line = hit ? view.trail.lines[hit.index] : 0;
  byId("picked").textContent = line > 0 ? `line ${line}` : "";
  return undefined;
}

function explainNoPicture(text) {
  byId("no-picture").hidden = text === "";
  byId("no-picture").textContent = text;
}

panel.theme = new Theme((theme) => view.setTheme(theme));

// ---- the picture's own buttons
for (const button of document.querySelectorAll("[data-view]")) {
  button.addEventListener("click", () => view.look(button.dataset.view));
}
for (const button of document.querySelectorAll("[data-show]")) {
  button.addEventListener("click", () => {
    const isShown = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", String(isShown));
    if (button.dataset.show === "follow") view.follow(isShown);
    else view.show(button.dataset.show, isShown);
  });
}

// ---- what the panel's process says
const receive = {
  machine(message) {
    display.setMachine(message);
    if (view instanceof View) explainNoPicture(message.scene ? "" : "The machine's file is longer than its topic carries: no picture.");
    panel.operate.setMachine(message.scene);
    // The workpiece may lie elsewhere now, and with it what was drawn on it.
    view.trail.clear();
    view.setMachine(message.scene);
    panel.jog.setMachine(message.scene);
    panel.scope.setMachine(message.scene);
  },
  frame(frame) {
    panel.frame = frame;
    panel.received = performance.now();
    display.setFrame(frame);
    panel.operate.setFrame(frame);
    panel.jog.setFrame(frame);
    panel.program.setFrame(frame);
    view.setAtPole(frame.at_pole);
    if (frame.joints) setMotion(frame);
  },
  news: (message) => display.setNews(message.items),
  reply: (message) => panel.operate.setReply(message),
  actions: (message) => panel.actions.setOpen(message.open),
  program: (message) => panel.program.setProgram(message),
  operator(message) {
    panel.operate.setOperator(message.who);
    panel.program.setOperator(message);
  },
  latency(message) {
    display.setLatency(message.stages);
    panel.timing.setLatency(message);
  },
  silent: () => setSilent("Silent"),
};

// What is shown is what was: nothing can be asked.
function setSilent(state) {
  panel.frame = null;
  view.trail.clear(); // where the tip goes meanwhile is no straight line
  panel.jog.setSilent();
  panel.operate.setSilent();
  panel.program.setButtons();
  display.setSilent(state);
}

// What takes kinematics: a machine whose file is too long for its topic has none here.
function setMotion(frame) {
  panel.scope.setFrame(frame);
  view.setJoints(frame.now ?? frame.joints, frame.tool_length);
  const top = Math.max(frame.feed_programmed, 1);
  view.trail.add(frame.trail, frame.feed_achieved / top);
}

function connect() {
  panel.operate = new Operate(link, () => panel.frame);
  panel.jog = new Jog(link, panel, panel.operate);
  panel.tabs = new Tabs();
  panel.actions = new Actions(panel.operate);
  panel.program = new Program(panel);
  panel.scope = new Scope(panel);
  panel.timing = new Timing();
}

if (embedded) panel.report = new Report(JSON.parse(embedded.textContent), view, display);
else connect();
