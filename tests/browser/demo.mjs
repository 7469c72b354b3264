// Opens the page of examples/browser in a headless Chromium with a software renderer, and plays with it.
//
//     node --experimental-websocket tests/browser/demo.mjs PAGE HASH [FOLDER FOR SCREENSHOTS]
//
// HASH is what `--hash` of the example prints: the fall of the page must be the same to the bit.
// Exit code 0: everything is as it should be, or there is no Chromium (and a line says so).

import assert from "node:assert/strict";
import { firstFrames, pause, withTab } from "./chromium.mjs";

const [page, hash, folder] = process.argv.slice(2);

await withTab(folder, async tab => {
  const { send, evaluate, screenshot, size, complaints } = tab;
  const mouse = (type, [x, y], more = {}) => send("Input.dispatchMouseEvent", { type, x, y, ...more });
  const heights = () => evaluate("Array.from(new Float32Array(demo.physics.memory.buffer, demo.physics.poses(), 7 * 1000)).filter((_, i) => i % 7 === 1 && _ > -1)");
  const mean = numbers => numbers.reduce((sum, x) => sum + x, 0) / numbers.length;

  await size(1280, 720);
  const first = await firstFrames(tab, page, "demo");
  console.log(`first frame after ${first.map(time => time.toFixed(0)).join(", ")} ms`);
  // The module is compiled first: half a second on an idle machine, more where others compile, too.
  assert(Math.min(...first) < 5000, "the first frame takes less than 5 s");
  assert.equal((await heights()).length, 36, "some are dropped at once");

  // A click drops what is chosen, where it is; it falls.
  await evaluate(`document.getElementById("count").value = "25"`);
  for (const type of ["mousePressed", "mouseReleased"]) await mouse(type, [640, 100], { button: "left", clickCount: 1 });
  let start = [];
  for (let tries = 0; tries < 50 && start.length !== 61; tries++) {
    await pause(50);
    start = await heights();
  }
  assert.equal(start.length, 61, "a click drops");
  await pause(1200);
  await screenshot("demo-falling");
  const later = await heights();
  assert(mean(later) < mean(start) - 0.1, `they fall: ${mean(start)} to ${mean(later)} m`);

  // A drag upward through those that lie blows them up.
  let lying = later;
  for (let tries = 0; tries < 200 && Math.max(...lying) > 0.03; tries++) {
    await pause(100);
    lying = await heights();
  }
  assert(Math.max(...lying) < 0.03, `they come to lie: ${Math.max(...lying)} m`);
  let highest = 0;
  await mouse("mousePressed", [560, 480], { button: "left", buttons: 1 });
  for (let i = 1; i <= 4; i++) {
    await mouse("mouseMoved", [560 + 36 * i, 480 - 60 * i], { button: "left", buttons: 1 });
    highest = Math.max(highest, ...await heights());
  }
  await mouse("mouseReleased", [704, 240], { button: "left" });
  for (let i = 0; i < 10; i++) {
    await pause(50);
    highest = Math.max(highest, ...await heights());
  }
  await screenshot("demo-blown");
  assert(highest > Math.max(...lying) + 0.02, `a drag blows: ${Math.max(...lying)} to ${highest} m`);

  const before = await evaluate("[demo.drawn, performance.now()]");
  await evaluate(`document.getElementById("count").value = "100"`);
  for (let i = 0; i < 4; i++) {
    for (const type of ["mousePressed", "mouseReleased"]) await mouse(type, [500 + 80 * i, 150], { button: "left", clickCount: 1 });
    await evaluate(`document.getElementById("kind").selectedIndex = ${(i + 1) % 4}`);
  }
  await pause(1500);
  await screenshot("demo-many");
  const after = await evaluate("[demo.drawn, performance.now()]");
  const rate = 1e3 * (after[0] - before[0]) / (after[1] - before[1]);
  console.log(`software renderer, 1280 × 720: ${rate.toFixed(1)} frames per second, ${(await evaluate("demo.stepTime")).toFixed(2)} ms per step`);

  // The same fall as the example's own, to the bit.
  const fall = await evaluate(`(() => {
    const p = demo.physics;
    p.start(7, 1);
    p.weather(0.5, 0.3);
    for (let kind = 0; kind < 4; kind++) p.release(kind, Math.fround(Math.fround(0.1) * kind), 0.8, 0, 20);
    const start = performance.now();
    p.step(240);
    const time = performance.now() - start;
    p.blow(0, 0.2, 0, 2, 1, 0);
    p.step(240);
    return [(p.hash() >>> 0).toString(16).padStart(8, "0"), time / 240];
  })()`);
  console.log(`80 bodies that fall: ${fall[1].toFixed(3)} ms per step; hash ${fall[0]}`);
  assert.equal(fall[0], hash, "the fall is the same as on the machine itself");
  assert.deepEqual(complaints, []);
});
