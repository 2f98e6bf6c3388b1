// SPDX-License-Identifier: Apache-2.0
// Dark and light: as the system has it, until somebody chooses; what was chosen is kept.
import { byId } from "./dom.js";

const kKept = "chosen-theme";

function kept() {
  try {
    const theme = localStorage.getItem(kKept);
    return theme === "dark" || theme === "light" ? theme : null;
  } catch {
    return null; // private windows keep nothing
  }
}

function keep(theme) {
  try {
    localStorage.setItem(kKept, theme);
  } catch {
    // Private windows keep nothing.
  }
}

export class Theme {
  // `onChange(theme)`: at once, and with every change.
  constructor(onChange) {
    this.onChange = onChange;
    this.chosen = kept();
    this.system = matchMedia("(prefers-color-scheme: light)");
    this.system.addEventListener("change", () => this.apply());
    byId("theme").addEventListener("click", () => this.choose(this.now === "dark" ? "light" : "dark"));
    this.apply();
  }

  get now() {
    return this.chosen ?? (this.system.matches ? "light" : "dark");
  }

  choose(theme) {
    this.chosen = theme;
    keep(theme);
    this.apply();
  }

  apply() {
    document.documentElement.dataset.theme = this.now;
    this.onChange(this.now);
  }
}
