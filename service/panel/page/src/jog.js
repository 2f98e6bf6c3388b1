// SPDX-License-Identifier: Apache-2.0
// Jog by press and hold, pointer or key. While it is held the page beats; whatever ends the beats ends the motion: letting
// go, focus lost, tab hidden, a page or browser that freezes or dies, a link that is cut.
import { byId, element } from "./dom.js";

const kBeat_ms = 40;
const kFresh_ms = 300;
const kToolAxes = ["tool x", "tool y", "tool z", "tilt a", "tilt b"];
const kToolVelocity = [50, 50, 50, 0.3, 0.3]; // mm/s, rad/s at full speed
const kRadian = Math.PI / 180;
const kKey = "key"; // presses in place of a pointer, which has a number

export class Jog {
  constructor(link, panel, operate) {
    this.link = link;
    this.panel = panel;
    this.operate = operate;
    this.held = null;
    this.grips = 0;
    const letGo = () => this.release();
    for (const kind of ["blur", "pagehide", "contextmenu"]) window.addEventListener(kind, letGo);
    document.addEventListener("visibilitychange", () => document.hidden && letGo());
    for (const kind of ["pointerup", "pointercancel", "lostpointercapture"]) window.addEventListener(kind, (event) => this.lift(event.pointerId));
    // While another button of the mouse is down, the release of the left one comes as a move.
    window.addEventListener("pointermove", (event) => (event.buttons & 1) === 0 && this.lift(event.pointerId));
    byId("jog-toggle").addEventListener("click", () => this.open(byId("jog").hidden));
  }

  open(isOpen) {
    byId("jog").hidden = !isOpen;
    byId("jog-toggle").setAttribute("aria-expanded", String(isOpen));
  }

  // `scene`: null where the joints are not known; then nothing can be jogged from here.
  setMachine(scene) {
    byId("jog-toggle").disabled = scene === null;
    if (!scene) {
      this.release();
      this.open(false);
      return byId("jog-rows").replaceChildren();
    }
    const rows = scene.joints.map((joint, i) =>
      this.row(joint.name, { tool: false, joint: i, full: joint.velocity, rotary: joint.rotary }));
    rows.push(element("hr"));
    kToolAxes.forEach((name, i) => rows.push(this.row(name, { tool: true, joint: i, full: kToolVelocity[i], rotary: i > 2 })));
    return byId("jog-rows").replaceChildren(...rows);
  }

  row(name, what) {
    const button = (sign, sight) => {
      const made = element("button", { type: "button", "aria-label": `${name} ${sign > 0 ? "plus" : "minus"}, press and hold` }, sight);
      made.addEventListener("pointerdown", (event) => {
        if (event.button !== 0 || !event.isPrimary) return;
        made.setPointerCapture(event.pointerId);
        this.press(made, what, sign, event.pointerId);
      });
      // A finger that rests is no question for a menu.
      made.addEventListener("contextmenu", (event) => {
        event.preventDefault();
        event.stopPropagation();
      });
      made.addEventListener("keydown", (event) => {
        if ((event.key !== " " && event.key !== "Enter") || event.repeat) return;
        event.preventDefault();
        this.press(made, what, sign, kKey);
      });
      // A browser may take the focus from a button that a finger presses again.
      for (const kind of ["keyup", "blur"]) made.addEventListener(kind, () => this.lift(kKey));
      return made;
    };
    return element("div", { class: "jog-row" }, button(-1, "\u2212"), element("b", {}, name), button(1, "+"));
  }

  press(button, what, sign, by) {
    this.release();
    const share = Number(byId("jog-speed").value);
    const step = Number(byId("jog-step").value);
    const plan = {
      tool: what.tool, joint: what.joint, velocity: sign * share * what.full,
      distance: what.rotary ? step * kRadian : step,
    };
    // A number that no other press of this page had: what is late of an old press moves nothing.
    this.held = { button, plan, by, id: ++this.grips };
    button.classList.add("held");
    this.beat();
    if (this.held) this.timer = setInterval(() => this.beat(), kBeat_ms);
  }

  beat() {
    const { frame, received } = this.panel;
    const isFresh = frame && performance.now() - received < kFresh_ms;
    if (!isFresh || !document.hasFocus() || document.hidden) return this.release();
    const { plan, id } = this.held;
    if (!this.link.say({ do: "jog", id, ...plan, seen: this.operate.quoted(frame) })) this.release();
    return undefined;
  }

  release() {
    if (!this.held) return;
    clearInterval(this.timer);
    this.held.button.classList.remove("held");
    this.link.say({ do: "release", id: this.held.id });
    this.held = null;
  }

  // That pointer or key is up, wherever: what another one presses stays pressed.
  lift(by) {
    if (this.held?.by === by) this.release();
  }

  setFrame(frame) {
    this.enable(this.operate.isOperator && (frame.can.includes("jog") || frame.state === "Jogging"));
  }

  setSilent() {
    this.enable(false);
  }

  enable(may) {
    for (const button of byId("jog-rows").querySelectorAll("button")) button.disabled = !may;
    if (!may) this.release();
  }
}
