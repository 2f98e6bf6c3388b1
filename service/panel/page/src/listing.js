// SPDX-License-Identifier: Apache-2.0
// The program's text around a line, fetched by pieces: a program may have a million lines.
import { element } from "./dom.js";

const kLines = 300;

export class Listing {
  constructor(box) {
    this.box = box;
    this.clear();
  }

  clear() {
    this.first = 0;
    this.rows = [];
    this.line = 0;
    this.box.replaceChildren();
  }

  // Brings `line` to the middle and marks it; nothing happens where it stands there already.
  async show(line) {
    if (line < 1 || line === this.line) return;
    this.line = line;
    const isThere = this.rows.length > 0 && line >= this.first && line < this.first + this.rows.length;
    if (!isThere) await this.fetch(line);
    if (line === this.line) this.mark(line);
  }

  async fetch(line) {
    const first = Math.max(1, line - kLines / 2);
    const answer = await fetch(`/program/lines?first=${first}&count=${kLines}`);
    if (!answer.ok || line !== this.line) return;
    const lines = (await answer.text()).split("\n").slice(0, -1);
    this.first = first;
    this.rows = lines.map((text, i) => element("div", {}, element("i", {}, String(first + i)), element("span", {}, text)));
    this.box.replaceChildren(...this.rows);
  }

  mark(line) {
    this.marked?.classList.remove("now");
    this.marked = this.rows[line - this.first];
    if (!this.marked) return;
    this.marked.classList.add("now");
    const { box, marked } = this;
    box.scrollTop = marked.offsetTop - box.offsetTop - box.clientHeight / 2;
  }
}
