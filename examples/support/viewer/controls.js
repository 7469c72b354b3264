// Viewports, time, and what mouse, fingers and keys do.

const state = { time: 0, playing: true, changed: true };
const layout = element("layout");
if (runs.length > 1) layout.add(new Option("side by side", "all"));
runs.forEach((run, i) => layout.add(new Option(run.name, i)));
layout.hidden = runs.length < 2;
element("time").max = duration;

// What is small beside its way is seen from near by, and followed.
if (header.follow) {
  element("follow").checked = true;
  view.distance = header.follow;
}

const shown = () => layout.value === "all" ? runs : [runs[layout.value]];

/** Where each shown run is on the page: beside each other, or on top of each other on upright screens. */
function rects() {
  const [width, height] = [innerWidth, innerHeight - element("bar").offsetHeight], count = shown().length, wide = width > height;
  return shown().map((run, i) => wide ? { run, x: i * width / count, y: 0, width: width / count, height }
    : { run, x: 0, y: i * height / count, width, height: height / count });
}

/** Gives a canvas so many pixels per pixel of the page. */
function fit(canvas, scale) {
  const [width, height] = [innerWidth, innerHeight].map(x => Math.round(x * scale));
  if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
}

function draw() {
  const sharp = Math.min(devicePixelRatio, 2), scale = sharp * coarseness;
  fit(overlay, sharp);
  fit(scene, scale);
  gl.clearColor(0.925, 0.941, 0.953, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
  paint.setTransform(sharp, 0, 0, sharp, 0, 0);
  paint.clearRect(0, 0, innerWidth, innerHeight);
  // Where it stays when it follows no longer.
  if (follows()) view.target = place(shown()[0], state.time, picked);
  for (const rect of rects()) {
    const camera = cameraOf(rect);
    drawScene(camera, rect, scale, rect.run, state.time);
    paint.save();
    paint.beginPath();
    paint.rect(rect.x, rect.y, rect.width, rect.height);
    paint.clip();
    drawLabels(camera, rect);
    if (picked >= 0) drawPicked(camera, rect, rect.run, state.time);
    paint.font = "600 16px system-ui, sans-serif";
    paint.textAlign = "left";
    paint.fillStyle = "#333";
    paint.fillText(rect.run.name, rect.x + 12, rect.y + 24);
    paint.strokeStyle = "#0003";
    paint.lineWidth = 1;
    paint.strokeRect(rect.x, rect.y, rect.width, rect.height);
    paint.restore();
  }
  element("picked").hidden = element("following").hidden = picked < 0;
  if (picked >= 0) describePicked(state.time);
  element("time").value = state.time;
  element("clock").textContent = `${state.time.toFixed(2)} / ${duration.toFixed(1)} s`;
  element("play").textContent = state.playing ? "❚❚" : "▶";
}

// What tests look at: frames drawn, and when the first was (ms since the page was opened).
const viewer = window.viewer = { view, drawn: 0, firstFrame: null, state, header, runs, pose, rects, cameraOf, projected, place,
  get picked() { return picked; } };

// Where frames take long, as on processors without graphics, bodies are drawn with fewer pixels; lines and text are not.
let coarseness = 1, pace = 16, before = performance.now();
function tick(now) {
  pace += 0.1 * (now - before - pace);
  if (pace > 50 && coarseness > 0.5) [coarseness, pace] = [0.7 * coarseness, 16];
  if (state.playing) {
    state.time += Math.max(0, Math.min(now - before, 200)) / 1e3 * element("speed").value;
    if (state.time > duration) state.time = 0;
  }
  before = now;
  if (state.playing || state.changed) {
    state.changed = false;
    draw();
    viewer.drawn++;
    if (viewer.firstFrame === null) {
      gl.finish();
      viewer.firstFrame = performance.now();
    }
  }
  requestAnimationFrame(tick);
}

const change = action => event => { action(event); state.changed = true; };
const toggle = change(() => state.playing = !state.playing);
const seek = time => { state.playing = false; state.time = Math.min(Math.max(time, 0), duration); };
element("play").onclick = toggle;
element("time").oninput = change(() => seek(+element("time").value));
layout.onchange = element("follow").onchange = change(() => {});
addEventListener("resize", change(() => {}));
addEventListener("keydown", change(event => {
  if (event.target.matches("select, button, input")) return;
  if (event.key === " ") toggle();
  if (event.key === "ArrowRight") seek(state.time + header.interval);
  if (event.key === "ArrowLeft") seek(state.time - header.interval);
  if (event.key === "Escape") picked = -1;
}));

const pointers = new Map();
let moved = 0;
const middle = () => { const all = [...pointers.values()]; return [0, 1].map(k => all.reduce((sum, p) => sum + p[k], 0) / all.length); };
const spread = () => { const [a, b] = pointers.values(); return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0; };
const zoom = factor => view.distance = Math.min(Math.max(view.distance * factor, 0.02), 500);

overlay.addEventListener("pointerdown", event => {
  overlay.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  moved = pointers.size > 1 ? Infinity : 0;
});
overlay.addEventListener("pointermove", change(event => {
  if (!pointers.has(event.pointerId)) return;
  const [from, wide] = [middle(), spread()];
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  const to = middle(), [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  moved += Math.hypot(dx, dy);
  if (pointers.size > 1 || event.buttons & 6 || event.shiftKey) {
    const rect = rects()[0], { right, up } = cameraOf(rect);
    const metres = 2 * view.distance * Math.tan(header.fieldOfView / 2) / Math.min(rect.width, rect.height);
    view.target = add(add(view.target, right, -dx * metres), up, dy * metres);
    if (wide > 0) zoom(wide / spread());
  } else {
    view.turn -= 0.006 * dx;
    view.tilt = Math.min(Math.max(view.tilt + 0.006 * dy, -1.55), 1.55);
  }
}));
overlay.addEventListener("pointerup", change(event => {
  pointers.delete(event.pointerId);
  if (moved < 5 && event.button === 0) pickAt(event.clientX, event.clientY);
}));
overlay.addEventListener("pointercancel", event => pointers.delete(event.pointerId));
overlay.addEventListener("wheel", change(event => { event.preventDefault(); zoom(Math.exp(0.001 * event.deltaY)); }), { passive: false });
overlay.addEventListener("dblclick", change(() => { picked = -1; resetView(); }));
overlay.addEventListener("contextmenu", event => event.preventDefault());

/** Picks the body whose middle is next to a point of the page, in units of its own size there or of ten pixels. */
function pickAt(x, y) {
  const rect = rects().find(r => x >= r.x && x < r.x + r.width && y >= r.y && y < r.y + r.height);
  if (!rect) return;
  const camera = cameraOf(rect), focal = 0.5 * Math.min(rect.width, rect.height) / Math.tan(header.fieldOfView / 2);
  let least = 1;
  picked = -1;
  header.bodies.forEach((body, i) => {
    const at = projected(camera, rect, place(rect.run, state.time, i));
    if (!at) return;
    const share = Math.hypot(at[0] - x, at[1] - y) / Math.max(10, meshes[body.mesh].radius * focal / at[2]);
    if (share < least) [least, picked] = [share, i];
  });
}

requestAnimationFrame(tick);
