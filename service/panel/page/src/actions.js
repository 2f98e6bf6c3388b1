// SPDX-License-Identifier: Apache-2.0
// What the path waits for, where the operator does it in place of a PLC.
import { byId, element } from "./dom.js";

export class Actions {
  constructor(operate) {
    this.operate = operate;
  }

  setOpen(open) {
    const rows = open.map(({ id, line, text }) => {
      const button = (done, words) => {
        const made = element("button", { type: "button", class: done ? "go" : "" }, words);
        const answer = () => this.operate.request({ do: "answer", action: id, done });
        const question = [`${text}: is it done?`, "The program goes on along its path.", ""];
        made.addEventListener("click", () => (done ? this.operate.confirm(question, answer) : answer()));
        return made;
      };
      return element("div", {}, element("b", {}, text), element("span", {}, `line ${line}: the program waits until it is done`),
        button(true, "Done"), button(false, "Cannot be done"));
    });
    byId("actions").replaceChildren(...rows);
    byId("actions").hidden = rows.length === 0;
  }
}
