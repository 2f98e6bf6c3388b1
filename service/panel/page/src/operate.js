// SPDX-License-Identifier: Apache-2.0
// What an operator asks for. Every word quotes the frame that he saw; the machine answers in words.
import { byId, setText } from "./dom.js";
import { Overrides } from "./overrides.js";

// Asked once more before they go out: they may move the machine.
const goesOn = ["Go on?", "The machine goes on along the path.", ""];
const kConfirmed = {
  start: (frame) => ["Start the program?", `${frame.program}: the machine moves to its first point.`, frame.message],
  resume: () => ["Resume?", "The machine goes on along the path.", ""],
  home: () => ["Home all joints?", "Every drive looks for its reference by itself.", ""],
  feed_override: (frame, share) => (frame.session && frame.feed_override === 0 && share > 0 ? goesOn : null),
  rapid_override: (frame, share) => (frame.session && frame.rapid_override === 0 && share > 0 ? goesOn : null),
};

export const kOnlyWatches = "This panel only watches.";

export class Operate {
  constructor(link, seen) {
    this.link = link;
    this.seen = seen;
    this.id = 0;
    this.asked = null;
    this.dialog = byId("confirm");
    for (const button of document.querySelectorAll("[data-verb]")) {
      button.addEventListener("click", () => this.press(button.dataset.verb));
    }
    for (const button of document.querySelectorAll("[data-switch]")) {
      button.addEventListener("click", () => this.ask(button.dataset.switch, button.getAttribute("aria-pressed") === "true" ? 0 : 1));
    }
    this.overrides = new Overrides((verb, share) => this.press(verb, share));
    byId("take-over").addEventListener("click", () => link.say({ do: "take_over", id: 0 }));
    byId("confirm-yes").addEventListener("click", () => this.dialog.close("yes"));
    byId("confirm-no").addEventListener("click", () => this.dialog.close("no"));
    this.dialog.addEventListener("close", () => {
      const { asked } = this;
      this.asked = null;
      if (this.dialog.returnValue === "yes") asked.onYes();
    });
    // A hold is never wrong.
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && !this.dialog.open && !this.isWatching) this.ask("hold", 0);
    });
  }

  press(verb, argument = 0) {
    const frame = this.seen(), words = frame && kConfirmed[verb]?.(frame, argument);
    if (words) this.confirm(words, () => this.ask(verb, argument));
    else this.ask(verb, argument);
  }

  // Asks once more, of the machine as it is seen now: a machine that changes meanwhile takes the question back.
  confirm([title, text, message], onYes) {
    this.asked = { frame: this.seen(), onYes };
    setText(byId("confirm-title"), title);
    setText(byId("confirm-text"), text);
    setText(byId("confirm-message"), message);
    this.dialog.returnValue = "no";
    if (!this.dialog.open) this.dialog.showModal();
  }

  takeBack(frame) {
    const before = this.asked.frame, approach = ({ state, message }) => state === "Loaded" && message;
    const isAsSeen = before && ["service", "epoch", "state", "program"].every((name) => frame[name] === before[name]);
    if (isAsSeen && approach(frame) === approach(before)) return;
    this.dialog.close("no");
    this.report(false, "the machine changed while it was asked: look again");
  }

  ask(verb, argument) {
    const frame = this.seen();
    if (!frame) return this.report(false, "no link to the machine: nothing was asked");
    const said = this.link.say({ do: verb, id: ++this.id, argument, seen: this.quoted(frame) });
    if (!said) this.report(false, "no link to the panel: nothing was asked");
    return undefined;
  }

  // What moves nothing: it quotes no frame.
  request(message) {
    const said = this.link.say({ ...message, id: ++this.id });
    if (!said) this.report(false, "no link to the panel: nothing was asked");
  }

  quoted(frame) {
    return { service: frame.service, epoch: frame.epoch, sequence: frame.sequence };
  }

  report(isAccepted, text) {
    if (!text) return;
    byId("reply").className = isAccepted ? "accepted" : "refused";
    setText(byId("reply"), text);
  }

  setFrame(frame) {
    if (this.asked) this.takeBack(frame);
    for (const button of document.querySelectorAll("[data-verb]")) {
      button.disabled = !this.isOperator || !frame.can.includes(button.dataset.verb);
    }
    // Stops are everybody's who may ask for anything.
    for (const verb of ["hold", "abort"]) {
      document.querySelector(`[data-verb="${verb}"]`).disabled = this.isWatching || !frame.can.includes(verb);
    }
    for (const button of document.querySelectorAll("[data-switch]")) {
      button.disabled = !this.isOperator || !frame.can.includes(button.dataset.switch);
      button.setAttribute("aria-pressed", String(frame[button.dataset.switch]));
    }
    this.overrides.enable(this.isOperator);
    this.overrides.setFrame(frame);
  }

  // Nobody would hear what was asked.
  setSilent() {
    for (const button of document.querySelectorAll("[data-verb], [data-switch]")) button.disabled = true;
    this.overrides.enable(false);
  }

  setMachine(scene) {
    this.overrides.setMax(scene?.max_override ?? 1);
  }

  setOperator(who) {
    this.isOperator = who === "you" || who === "nobody";
    this.isWatching = who === "watching";
    document.body.dataset.operator = who;
    byId("take-over").hidden = who !== "another";
    setText(byId("who"), { another: "Another page operates this machine.", watching: kOnlyWatches }[who] ?? "");
  }

  setReply(message) {
    this.report(message.accepted, message.accepted ? message.text : `refused: ${message.text.replace(/^refused: /, "")}`);
  }
}
