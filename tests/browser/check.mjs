// Opens a page that html.rs wrote in a headless Chromium with a software renderer, plays with it and measures it.
//
//     node --experimental-websocket tests/browser/check.mjs out/leaves.html [FOLDER FOR SCREENSHOTS]
//
// Exit code 0: everything is as it should be, or there is no Chromium (and a line says so).

import assert from "node:assert/strict";
import { firstFrames, pause, withTab } from "./chromium.mjs";

const [page, folder] = process.argv.slice(2);

await withTab(folder, async tab => {
  const { send, evaluate, screenshot, size, complaints } = tab;
  const mouse = (type, [x, y], more = {}) => send("Input.dispatchMouseEvent", { type, x, y, ...more });
  async function click(at) {
    for (const type of ["mousePressed", "mouseReleased"]) await mouse(type, at, { button: "left", clickCount: 1 });
  }
  async function key(name, text) {
    for (const type of ["keyDown", "keyUp"]) await send("Input.dispatchKeyEvent", { type, key: name, text: type === "keyDown" ? text : undefined });
  }
  const seek = time => evaluate(`viewer.state.playing = false; viewer.state.time = ${time}; viewer.state.changed = true`);
  const eye = () => evaluate("viewer.cameraOf(viewer.rects()[0]).eye");

  await size(1280, 720);
  const first = await firstFrames(tab, page, "viewer");
  const bodies = await evaluate("viewer.header.bodies.length");
  const times = first.map(time => time.toFixed(0)).join(", ");
  console.log(`${bodies} bodies, ${await evaluate("viewer.runs.length")} runs: first frame after ${times} ms`);
  assert(Math.min(...first) < 2000, "the first frame takes less than 2 s");

  const rate = async what => {
    const before = await evaluate("[viewer.drawn, performance.now()]");
    await pause(3000);
    const after = await evaluate("[viewer.drawn, performance.now()]");
    const rate = 1e3 * (after[0] - before[0]) / (after[1] - before[1]);
    console.log(`software renderer, 1280 × 720, ${what}: ${rate.toFixed(1)} frames per second`);
    assert(rate > 0, "it goes on");
  };
  await rate("all runs");
  const duration = await evaluate("(viewer.header.frames - 1) * viewer.header.interval");
  // A short recording may have begun anew just now.
  let plays = false;
  for (let tries = 0; tries < 40 && !plays; tries++, await pause(50)) plays = await evaluate("viewer.state.time > 0");
  assert(plays, "it plays by itself");

  await seek(0.2 * duration);
  await screenshot("side-by-side");
  // What has been shown does not change what is decoded: unit quaternions, and places in the box.
  const poses = await evaluate(`viewer.runs.flatMap(run => viewer.header.bodies.map((_, body) => {
    const out = []; viewer.pose(run, viewer.state.time, body, out); return out; }))`);
  const { low, size: box } = await evaluate("viewer.header");
  for (const pose of poses) {
    assert(Math.abs(Math.hypot(...pose.slice(3)) - 1) < 1e-9);
    for (let k = 0; k < 3; k++) assert(pose[k] >= low[k] - 1e-9 && pose[k] <= low[k] + box[k] + 1e-9);
  }

  const middle = [320, 300], start = await eye();
  await mouse("mousePressed", middle, { button: "left", buttons: 1 });
  await mouse("mouseMoved", [380, 320], { button: "left", buttons: 1 });
  await mouse("mouseReleased", [380, 320], { button: "left" });
  const turned = await eye();
  assert.notDeepEqual(turned, start, "dragging turns the view");
  const pickedAtFirst = bodies === 1 || await evaluate("viewer.header.follow !== null") ? 0 : -1;
  assert.equal(await evaluate("viewer.picked"), pickedAtFirst, "dragging picks nothing");
  await mouse("mouseWheel", middle, { deltaX: 0, deltaY: -300 });
  await pause(100);
  assert.notDeepEqual(await eye(), turned, "the wheel zooms");

  // From the middle of the list on, the first body that is in the picture.
  const at = await evaluate(`(() => { const rect = viewer.rects()[0], count = viewer.header.bodies.length;
    for (let i = 0; i < count; i++) {
      const body = (Math.floor(count / 2) + i) % count;
      const at = viewer.projected(viewer.cameraOf(rect), rect, viewer.place(viewer.runs[0], viewer.state.time, body));
      if (at && at[0] > rect.x && at[0] < rect.x + rect.width && at[1] > rect.y && at[1] < rect.y + rect.height) return at.slice(0, 2);
    }
    return null; })()`);
  assert.notEqual(at, null, "a body is in the picture");
  await click(at);
  await pause(100);
  const picked = await evaluate("viewer.picked");
  assert(picked >= 0, "a click picks");
  await screenshot("picked");

  await evaluate(`document.getElementById("layout").value = "0"; document.getElementById("layout").onchange()`);
  await seek(duration);
  await screenshot("end");
  await evaluate("viewer.state.playing = true; viewer.state.time = 0");
  await rate("one run");
  const playing = await evaluate("document.activeElement.blur(), viewer.state.playing");
  await key(" ", " ");
  assert.equal(await evaluate("viewer.state.playing"), !playing, "the space bar stops and starts it");
  await key("Escape");
  assert.equal(await evaluate("viewer.picked"), -1, "Escape lets go");

  await size(390, 844);
  await evaluate(`const all = document.getElementById("layout"); all.selectedIndex = 0; all.onchange()`);
  await seek(0.3 * duration);
  await screenshot("upright");
  const distance = () => evaluate("viewer.view.distance"), far = await distance();
  await send("Emulation.setTouchEmulationEnabled", { enabled: true, maxTouchPoints: 2 });
  const touch = (type, points) => send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  await touch("touchStart", [[150, 300], [250, 300]]);
  await touch("touchMove", [[100, 300], [300, 300]]);
  await touch("touchEnd", []);
  await pause(100);
  assert(await distance() < 0.8 * far, "two fingers apart come closer");
});
