// SPDX-License-Identifier: Apache-2.0
// Bytes to a panel as no browser sends them.
import { connect } from "node:net";

// The request that opens a link, of a page at `origin`.
export const upgrade = (host, origin = `http://${host}`) =>
  `GET /live HTTP/1.1\r\nHost: ${host}\r\nOrigin: ${origin}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n` +
  "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";

// A frame of a link as a browser masks it, the mask all zeros.
export function frame(text, opcode = 1) {
  const body = Buffer.from(text, "latin1"), isLong = body.length > 125;
  const head = [0x80 | opcode, 0x80 | (isLong ? 126 : body.length), ...(isLong ? [body.length >> 8, body.length & 255] : []), 0, 0, 0, 0];
  return Buffer.concat([Buffer.from(head), body]);
}

// One connection with these bytes; what came back until the panel hung up, or within a moment.
export function exchange(url, bytes, ms = 400) {
  return new Promise((done) => {
    const { port, hostname } = new URL(url);
    let text = "";
    const socket = connect(Number(port), hostname, () => socket.write(bytes));
    const timer = setTimeout(() => end(), ms);
    const end = () => (clearTimeout(timer), socket.destroy(), done(text));
    socket.on("data", (data) => (text += data.toString("latin1")));
    socket.on("error", end);
    socket.on("close", end);
  });
}
