// A headless Chromium with a software renderer, for the checks beside this file.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

export const pause = ms => new Promise(end => setTimeout(end, ms));

/** The first Chromium that starts, and the address at which it takes commands. */
async function start(profile) {
  const flags = ["--headless=new", "--no-sandbox", "--no-first-run", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    "--remote-debugging-port=0", `--user-data-dir=${profile}`, "about:blank"];
  for (const name of [process.env.CHROMIUM, "chromium", "chromium-browser", "google-chrome"].filter(Boolean)) {
    const browser = spawn(name, flags, { stdio: ["ignore", "ignore", "pipe"] });
    const address = await new Promise(found => {
      let told = "";
      browser.on("error", () => found(null));
      browser.on("exit", () => found(null));
      browser.stderr.on("data", data => {
        told += data;
        const match = told.match(/DevTools listening on (ws:\S+)/);
        if (match) found(match[1]);
      });
    });
    if (address) return { browser, address };
  }
  return null;
}

/**
 * Loads a page three times, and waits for its first frame, of which `window.<name>.firstFrame` tells, ms since the page was opened.
 * The least of the three is the page's own: the others have in them whatever else the machine did at the time.
 */
export async function firstFrames({ send, evaluate, complaints }, page, name) {
  const first = [];
  for (let load = 0; load < 3; load++) {
    await send("Page.navigate", { url: "about:blank" });
    await send("Page.navigate", { url: pathToFileURL(resolve(page)).href });
    let time = null;
    for (let tries = 0; tries < 400 && time === null && complaints.length === 0; tries++) {
      await pause(50);
      time = await evaluate(`window.${name}?.firstFrame ?? null`);
    }
    assert.deepEqual(complaints, []);
    assert.notEqual(time, null, "a frame is drawn");
    first.push(time);
  }
  return first;
}

/**
 * Opens an empty tab and lets `play` do with it what it likes; screenshots go to `folder`, if there is one.
 * Ends the process: with 0 if nothing is thrown, or if there is no Chromium (and a line says so).
 */
export async function withTab(folder, play) {
  const profile = mkdtempSync(join(tmpdir(), "viewer-"));
  const started = await start(profile);
  if (!started) {
    console.log("the page is not tested: no Chromium starts here (name one in CHROMIUM)");
    process.exit(0);
  }
  const socket = new WebSocket(started.address);
  await new Promise(open => socket.addEventListener("open", open));
  let count = 0, session;
  const waiting = new Map(), complaints = [], requests = [];
  socket.addEventListener("message", ({ data }) => {
    const { id, method, params, result, error } = JSON.parse(data);
    if (id) waiting.get(id)(error ? Promise.reject(new Error(error.message)) : result);
    if (method === "Runtime.exceptionThrown") complaints.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (method === "Runtime.consoleAPICalled") complaints.push(params.args.map(arg => arg.value).join(" "));
    if (method === "Log.entryAdded") complaints.push(`${params.entry.text} ${params.entry.url ?? ""}`);
    if (method === "Network.requestWillBeSent") requests.push(params.request.url.slice(0, 100));
  });
  const send = (method, params = {}) => new Promise(answer => {
    waiting.set(++count, answer);
    socket.send(JSON.stringify({ id: count, method, params, sessionId: session }));
  });
  async function evaluate(expression) {
    const { result, exceptionDetails } = await send("Runtime.evaluate", { expression, returnByValue: true });
    assert(!exceptionDetails, `${expression}: ${exceptionDetails?.exception?.description}`);
    return result.value;
  }
  async function screenshot(name) {
    await pause(400);
    if (!folder) return;
    mkdirSync(folder, { recursive: true });
    const { data } = await send("Page.captureScreenshot", { format: "png" });
    writeFileSync(join(folder, `${name}.png`), Buffer.from(data, "base64"));
  }
  const size = (width, height) => send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
  let failure = null;
  try {
    const { targetId } = await send("Target.createTarget", { url: "about:blank" });
    ({ sessionId: session } = await send("Target.attachToTarget", { targetId, flatten: true }));
    for (const domain of ["Page", "Runtime", "Log", "Network"]) await send(`${domain}.enable`);
    await play({ send, evaluate, screenshot, size, complaints, requests });
    assert.deepEqual(complaints, []);
    // Images that a page holds in itself are no requests.
    assert.deepEqual(requests.filter(url => !/^(file|data):/.test(url)), [], "nothing is loaded");
    console.log("no complaints, no requests but for the page itself");
  } catch (error) {
    failure = error;
  }
  started.browser.kill();
  await new Promise(end => started.browser.on("exit", end));
  rmSync(profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 200 });
  if (failure) throw failure;
  process.exit(0);
}
