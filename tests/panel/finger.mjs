// SPDX-License-Identifier: Apache-2.0
// Fingers on a touch screen, as the browser gets them from one.
export class Fingers {
  static async of(page) {
    const fingers = new Fingers();
    fingers.cdp = await page.context().newCDPSession(page);
    return fingers;
  }

  send(type, points) {
    return this.cdp.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  }

  down(...points) {
    return this.send("touchStart", points);
  }

  move(...points) {
    return this.send("touchMove", points);
  }

  up() {
    return this.send("touchEnd", []);
  }

  cancel() {
    return this.send("touchCancel", []);
  }
}

export const middleOf = async (page, selector) => {
  const box = await page.locator(selector).boundingBox();
  return [box.x + box.width / 2, box.y + box.height / 2];
};
