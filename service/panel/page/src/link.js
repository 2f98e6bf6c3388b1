// SPDX-License-Identifier: Apache-2.0
// The link to the panel's process. It comes back by itself; a page whose link was cut asks for nothing by itself.
export class Link {
  constructor(onText, onChange) {
    this.onText = onText;
    this.onChange = onChange;
    this.connect();
  }

  connect() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${location.host}/live`);
    this.socket.addEventListener("open", () => this.onChange(true));
    this.socket.addEventListener("message", (event) => this.onText(JSON.parse(event.data)));
    this.socket.addEventListener("close", () => {
      this.onChange(false);
      this.askAgain();
      setTimeout(() => this.connect(), 1000);
    });
  }

  // A panel that was started anew knows no session of before: its page asks for the token.
  askAgain() {
    fetch("/", { method: "HEAD" }).then(({ status }) => status === 401 && location.reload(), () => {});
  }

  get isOpen() {
    return this.socket.readyState === WebSocket.OPEN;
  }

  // False where it could not be said, or where it would wait behind what was said before.
  say(message) {
    if (!this.isOpen || this.socket.bufferedAmount > 4096) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }
}
