// SPDX-License-Identifier: Apache-2.0
// Stands for the picture (view.js) in a browser that cannot draw one: everything else on the page works on.
export class NoView {
  constructor() {
    this.trail = { lines: [], add() {}, clear() {} };
  }

  setMachine(description) {
    this.description = description;
  }

  setPath() {}
  setTheme() {}
  setJoints() {}
  setAtPole() {}
  look() {}
  follow() {}
  show() {}
}
