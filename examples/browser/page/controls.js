// Time, and what mouse, fingers and buttons do.

const DT = 1 / 240, MOST_STEPS = 12;
const run = { poses: null };
// What tests look at.
const demo = window.demo = { physics, drawn: 0, firstFrame: null, stepTime: 0, dropped: 0 };

function weather() {
  const [wind, gusts] = [+element("wind").value, +element("gusts").value];
  element("windShown").textContent = `${wind.toFixed(1)} m/s`;
  element("gustsShown").textContent = `${gusts.toFixed(1)} m/s`;
  physics.weather(wind, gusts);
}

function again() {
  physics.start(7, element("immersed").checked ? 1 : 0);
  demo.dropped = 0;
  weather();
}
element("wind").oninput = element("gusts").oninput = weather;
element("again").onclick = element("immersed").onchange = again;

const rect = () => ({ x: 0, y: 0, width: innerWidth, height: innerHeight - element("bar").offsetHeight });

/** Metres per pixel at the distance of what the camera looks at. */
const metres = area => 2 * view.distance * Math.tan(header.fieldOfView / 2) / Math.min(area.width, area.height);

/** The point under the pointer in the plane through what the camera looks at, not under the floor. */
function pointUnder(x, y) {
  const area = rect(), { right, up } = cameraOf(area), scale = metres(area);
  const point = add(add(view.target, right, (x - 0.5 * area.width) * scale), up, (0.5 * area.height - y) * scale);
  return [Math.min(Math.max(point[0], -FLOOR), FLOOR), Math.max(point[1], 0.05), Math.min(Math.max(point[2], -FLOOR), FLOOR)];
}

const pointers = new Map();
let moved = 0, blown = null;
const spread = () => { const [a, b] = pointers.values(); return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0; };
const zoom = factor => view.distance = Math.min(Math.max(view.distance * factor, 0.3), 20);

overlay.addEventListener("pointerdown", event => {
  overlay.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  moved = pointers.size > 1 ? Infinity : 0;
  blown = { at: pointUnder(event.clientX, event.clientY), time: event.timeStamp };
});
overlay.addEventListener("pointermove", event => {
  const from = pointers.get(event.pointerId);
  if (!from) return;
  const wide = spread();
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  const [dx, dy] = [event.clientX - from[0], event.clientY - from[1]];
  moved += Math.hypot(dx, dy);
  if (pointers.size > 1 || event.buttons & 6 || event.shiftKey) {
    view.turn -= 0.006 * dx / pointers.size;
    view.tilt = Math.min(Math.max(view.tilt + 0.006 * dy / pointers.size, 0.02), 1.5);
    if (wide > 0) zoom(wide / spread());
  } else if (event.timeStamp > blown.time + 20) {
    // Air on the pointer's way moves twice as fast as the pointer, up to 6 m/s.
    const at = pointUnder(event.clientX, event.clientY), seconds = (event.timeStamp - blown.time) / 1e3;
    const velocity = scaled(add(at, blown.at, -1), 2 / seconds), speed = Math.hypot(...velocity);
    const middle = scaled(add(at, blown.at), 0.5);
    if (moved > 8) physics.blow(...middle, ...scaled(velocity, Math.min(1, 6 / (speed || 1))));
    blown = { at, time: event.timeStamp };
  }
});
overlay.addEventListener("pointerup", event => {
  pointers.delete(event.pointerId);
  if (moved > 8 || event.button !== 0) return;
  const [x, y, z] = pointUnder(event.clientX, event.clientY), count = +element("count").value;
  physics.release(element("kind").selectedIndex, x, Math.max(y, 0.4), z, count);
  demo.dropped += count;
});
overlay.addEventListener("pointercancel", event => pointers.delete(event.pointerId));
overlay.addEventListener("wheel", event => { event.preventDefault(); zoom(Math.exp(0.001 * event.deltaY)); }, { passive: false });
overlay.addEventListener("contextmenu", event => event.preventDefault());

function fit(canvas, scale) {
  const [width, height] = [innerWidth, innerHeight].map(x => Math.round(x * scale));
  if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
}

let coarseness = 1, pace = 16, before = performance.now(), due = 0;
function tick(now) {
  const passed = Math.max(0, now - before);
  before = now;
  pace += 0.1 * (passed - pace);
  if (pace > 50 && coarseness > 0.5) [coarseness, pace] = [0.7 * coarseness, 16];
  // What a slow machine cannot follow it shows more slowly.
  due = Math.min(due + passed / 1e3 / DT, MOST_STEPS);
  const steps = Math.floor(due);
  due -= steps;
  if (steps > 0) {
    const start = performance.now();
    physics.step(steps);
    demo.stepTime += 0.05 * ((performance.now() - start) / steps - demo.stepTime);
  }
  run.poses = new Float32Array(memory(), physics.poses(), 7 * bodyCount);
  const sharp = Math.min(devicePixelRatio, 2), area = rect();
  fit(overlay, sharp);
  fit(scene, sharp * coarseness);
  gl.clearColor(0.925, 0.941, 0.953, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
  drawScene(cameraOf(area), area, sharp * coarseness, run, 0);
  element("cost").textContent = `${demo.dropped} dropped\n${demo.stepTime.toFixed(2)} ms per step of 1/240 s\n${(1e3 / pace).toFixed(0)} frames per second`;
  demo.drawn++;
  demo.firstFrame ??= performance.now();
  requestAnimationFrame(tick);
}

weather();
for (const kind of [0, 0, 2]) physics.release(kind, 0.1 * kind, 1.2, 0, 12);
demo.dropped = 36;
requestAnimationFrame(tick);
