// SPDX-License-Identifier: Apache-2.0
// The views beside the machine. Arrow keys go from one to the next, as tabs do.
import { byId } from "./dom.js";

export class Tabs {
  constructor() {
    this.tabs = [...document.querySelectorAll("[role=tab]")];
    this.tabs.forEach((tab, i) => {
      tab.addEventListener("click", () => this.show(tab.id));
      tab.addEventListener("keydown", (event) => {
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (!step) return;
        const next = this.tabs[(i + step + this.tabs.length) % this.tabs.length];
        next.focus();
        this.show(next.id);
      });
    });
    this.show("tab-machine");
  }

  show(id) {
    for (const tab of this.tabs) {
      const isShown = tab.id === id;
      tab.setAttribute("aria-selected", String(isShown));
      tab.tabIndex = isShown ? 0 : -1;
      const sheet = tab.getAttribute("aria-controls");
      if (sheet) byId(sheet).hidden = !isShown;
    }
    document.body.dataset.view = id.replace("tab-", "");
    window.dispatchEvent(new Event("meridian-view"));
  }
}
