// SPDX-License-Identifier: Apache-2.0
// token_test.mjs BIN SOURCE: a panel with a token behind a TLS proxy, and who reaches it.
import { request } from "node:https";
import { request as plainRequest } from "node:http";
import { resolve } from "node:path";
import { must } from "./page_hand.mjs";
import { Plant } from "./plant.mjs";

const [bin, source] = process.argv.slice(2).map((path) => resolve(path));
const plant = new Plant(bin, source, "lai.toml");

// Status, headers and text of one request; status 0: hung up on, as a link is that is refused.
function ask(base, path, { method = "GET", headers = {}, body = "" } = {}) {
  const send = base.startsWith("https:") ? request : plainRequest;
  return new Promise((done, fail) => {
    const options = { method, headers: { ...headers, ...(body ? { "Content-Length": body.length } : {}) }, rejectUnauthorized: false, agent: false };
    const asked = send(new URL(path, base), options, (answer) => {
      let text = "";
      answer.on("data", (data) => (text += data));
      answer.on("end", () => done({ status: answer.statusCode, headers: answer.headers, text }));
    });
    asked.on("upgrade", (answer, socket) => (socket.destroy(), done({ status: answer.statusCode, headers: answer.headers, text: "" })));
    asked.on("error", (error) => (error.code === "ECONNRESET" ? done({ status: 0, headers: {}, text: "" }) : fail(error)));
    asked.end(body);
  });
}

const upgrade = (origin, headers = {}) => ({ headers: { Origin: origin, Upgrade: "websocket", Connection: "Upgrade",
  "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Version": "13", ...headers } });
const login = (origin, token) => ({ method: "POST", body: `token=${token}`, headers: { Origin: origin, "Content-Type": "application/x-www-form-urlencoded" } });

async function nobodyReachesMoreThanThePageThatAsks({ secured, url }) {
  for (const base of [secured, url.replace(/\/$/, "")]) {
    const page = await ask(base, "/");
    must(page.status === 401 && page.text.includes('name="token"'), "the page does not ask for the token");
    for (const path of ["/panel.js", "/metrics", "/program/lines?first=1&count=4"]) {
      must((await ask(base, path)).status === 401, `${path} is served without a token`);
    }
    must((await ask(base, "/program?key=&name=a", { method: "POST", body: "FINI", headers: { Origin: base } })).status === 401, "a program is taken without a token");
    must((await ask(base, "/live", upgrade(base))).status !== 101, "a link is opened without a token");
  }
}

async function theTokenOpensASession({ secured, token }) {
  must((await ask(secured, "/login", login(secured, "wrong"))).status === 401, "a wrong token is taken");
  must((await ask(secured, "/login", login("https://evil.example", token))).status === 403, "another site logs in");
  const done = await ask(secured, "/login", login(secured, token));
  const [cookie] = done.headers["set-cookie"] ?? [""];
  must(done.status === 303 && /Secure/.test(cookie) && /HttpOnly/.test(cookie), "the session is not secured");
  const headers = { Cookie: cookie.split(";")[0] };
  must((await ask(secured, "/panel.js", { headers })).status === 200, "the session does not open the page");
  must((await ask(secured, "/live", upgrade(secured, headers))).status === 101, "the session opens no link");
  must((await ask(secured, "/live", upgrade("https://evil.example", headers))).status !== 101, "another site uses the session");
  must((await ask(secured, "/", { headers: { ...headers, Host: "evil.example" } })).status === 403, "a foreign name is served");
  return headers;
}

async function programsShowTheTokenEachTime({ secured, token }) {
  const figures = await ask(secured, "/metrics", { headers: { Authorization: `Bearer ${token}` } });
  must(figures.status === 200 && figures.text.includes("meridian_up"), "Prometheus gets no figures");
}

async function guessingIsHeldUpAndSessionsGoOn({ secured, token }, headers) {
  for (let n = 0; n < 8; ++n) await ask(secured, "/login", login(secured, `guess${n}`));
  must((await ask(secured, "/login", login(secured, token))).status === 429, "guesses are not held up");
  must((await ask(secured, "/panel.js", { headers })).status === 200, "guesses of others end a session");
}

function whatIsNotSecuredIsRefused({ tokenFile }) {
  const refused = (...words) => plant.tool("panel", "--domain", plant.domain, "--port", "0", "--timeout", "5", ...words);
  must(/failed \(2\).*--token FILE/s.test(refused("--public", "https://localhost:8443")), "a public panel without a token starts");
  must(/failed \(2\).*https:\/\/NAME/s.test(refused("--public", "http://localhost", "--token", tokenFile)), "a public panel without TLS starts");
  must(/failed \(2\).*openssl rand/s.test(refused("--token", "/no/such/file")), "a panel without its token file starts");
}

try {
  await plant.start();
  const elsewhere = await plant.startPanelElsewhere();
  await nobodyReachesMoreThanThePageThatAsks(elsewhere);
  const headers = await theTokenOpensASession(elsewhere);
  await programsShowTheTokenEachTime(elsewhere);
  whatIsNotSecuredIsRefused(elsewhere);
  await guessingIsHeldUpAndSessionsGoOn(elsewhere, headers);
  elsewhere.proxy.close();
  console.log("ok");
} catch (error) {
  console.error(`FAILED: ${error.message}`);
  process.exitCode = 1;
} finally {
  await plant.stop();
}
process.exit();
