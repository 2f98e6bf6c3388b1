// SPDX-License-Identifier: Apache-2.0
// How long every stage of the cycle takes, beside its budgets.
import { byId, element } from "./dom.js";
import { fixed } from "./units.js";

const time = (us) => (us >= 10000 ? `${fixed(us / 1000, 1)} ms` : us >= 100 ? `${fixed(us, 0)} \u00b5s` : `${fixed(us, 1)} \u00b5s`);

export class Timing {
  constructor() {
    window.addEventListener("meridian-view", () => {
      this.draw();
      this.askDoctor();
    });
  }

  // What the host lacks for real time, whenever the view is opened.
  async askDoctor() {
    if (byId("sheet-timing").hidden) return;
    try {
      const answer = await fetch("/doctor");
      if (answer.ok) this.drawDoctor((await answer.json()).findings);
    } catch {
      // The link says that the panel is gone.
    }
  }

  drawDoctor(findings) {
    const rank = { bad: 0, note: 1, fine: 2 };
    const rows = findings.sort((a, b) => rank[a.health] - rank[b.health]).map(({ what, health, found, remedy }) =>
      element("li", { class: health }, element("b", {}, what), element("span", {}, found), element("small", {}, remedy)));
    byId("timing-doctor").replaceChildren(...rows);
  }

  setLatency(message) {
    this.message = message;
    this.draw();
  }

  draw() {
    if (!this.message || byId("sheet-timing").hidden) return;
    byId("timing-stages").replaceChildren(...this.message.stages.map((stage) => this.card(stage)));
  }

  // Where `us` lies in the bins of all stages, 0 to 1.
  at(us, count) {
    const { first_us, per_octave } = this.message;
    return Math.min(Math.max((per_octave * Math.log2(us / first_us)) / count, 0), 1);
  }

  card(stage) {
    const highest = Math.log1p(Math.max(1, ...stage.bins));
    const bars = stage.bins.map((count) => {
      const bar = element("i");
      bar.style.height = `${(100 * Math.log1p(count)) / highest}%`;
      return bar;
    });
    const limits = stage.budgets.filter((budget) => budget.limit !== undefined).map((budget) => {
      const mark = element("u", { title: `${budget.statistic} ${budget.text}` });
      mark.style.left = `${100 * this.at(budget.limit, stage.bins.length)}%`;
      return mark;
    });
    const { first_us, per_octave } = this.message;
    const end_us = first_us * 2 ** (stage.bins.length / per_octave);
    const scale = [first_us, Math.sqrt(first_us * end_us), end_us].map((us) => element("span", {}, time(us)));
    const figures = [["p50", stage.p50], ["p99", stage.p99], ["p99.9", stage.p999], ["max", stage.max]];
    return element("article", { class: "stage-card" },
      element("h3", {}, stage.name),
      element("div", { class: "bars", role: "img", "aria-label": `distribution of ${stage.count} values` }, ...bars, ...limits),
      element("div", { class: "scale" }, ...scale),
      element("dl", {}, ...figures.flatMap(([name, us]) => [element("dt", {}, name), element("dd", {}, time(us))])),
      ...stage.budgets.map((budget) => this.budget(budget)));
  }

  budget({ statistic, text, limit, figure }) {
    if (limit === undefined) return element("p", {}, `budget: ${statistic} ${text} (meridian probe measures that)`);
    const isKept = figure <= limit;
    return element("p", { class: isKept ? "good" : "bad" }, `${isKept ? "kept" : "exceeded"}: ${statistic} ${text}`);
  }
}
