// Labels, paths and arrows, which are drawn over the scene in two dimensions.

// None is -1; the only one needs no picking.
let picked = bodyCount === 1 || header.follow ? 0 : -1;

function stroke(camera, rect, points, color, width) {
  paint.strokeStyle = color;
  paint.lineWidth = width;
  paint.beginPath();
  let pen = false;
  for (const p of points) {
    const at = projected(camera, rect, p);
    if (at) paint[pen ? "lineTo" : "moveTo"](at[0], at[1]);
    pen = at !== null;
  }
  paint.stroke();
}

function drawLabels(camera, rect) {
  const [x0, x1, z0, z1] = gridEnds, show = value => value.toFixed(grid.digits).replace(/^-(0(\.0*)?)$/, "$1");
  const label = (text, p) => {
    const at = projected(camera, rect, p);
    if (at) paint.fillText(text, at[0], at[1]);
  };
  paint.font = "11px system-ui, sans-serif";
  paint.textAlign = "center";
  paint.fillStyle = "#444";
  // On the sides that the camera is at; heights on the far corner.
  const nearX = camera.eye[0] > view.target[0] ? [x1, x0] : [x0, x1], nearZ = camera.eye[2] > view.target[2] ? [z1, z0] : [z0, z1];
  const out = 0.35 * grid.step;
  for (const x of grid.x) label(show(x) + (x === x1 ? " m x" : ""), [x, ground, nearZ[0] + Math.sign(nearZ[0] - nearZ[1]) * out]);
  for (const z of grid.z) label(show(z) + (z === z1 ? " m z" : ""), [nearX[0] + Math.sign(nearX[0] - nearX[1]) * out, ground, z]);
  const post = y => [nearX[1], y, nearZ[1]], top = grid.heights.at(-1);
  stroke(camera, rect, [post(ground), post(top)], "#0004", 1);
  paint.textAlign = "right";
  for (const y of grid.heights.slice(1)) label(show(y - ground) + (y === top ? " m –" : " –"), post(y));
}

function drawArrow(camera, rect, from, force, color) {
  const start = projected(camera, rect, from), end = projected(camera, rect, add(from, force));
  if (!start || !end) return;
  const [dx, dy] = [end[0] - start[0], end[1] - start[1]], length = Math.hypot(dx, dy);
  if (length < 2) return;
  const head = Math.min(9, 0.5 * length), [ux, uy] = [dx / length * head, dy / length * head];
  paint.strokeStyle = paint.fillStyle = color;
  paint.lineWidth = 2.5;
  paint.beginPath();
  paint.moveTo(start[0], start[1]);
  paint.lineTo(end[0] - ux, end[1] - uy);
  paint.stroke();
  paint.beginPath();
  paint.moveTo(end[0], end[1]);
  paint.lineTo(end[0] - ux - 0.5 * uy, end[1] - uy + 0.5 * ux);
  paint.lineTo(end[0] - ux + 0.5 * uy, end[1] - uy - 0.5 * ux);
  paint.fill();
}

/** The picked body's path, and arrows that are as long as a fixed share of the view for its weight. */
function drawPicked(camera, rect, run, time) {
  const at = place(run, time, picked), path = [], now = Math.floor(time / header.interval || 0), out = [];
  for (let frame = 0; frame <= lastFrame; frame++) {
    key(run, frame, picked, out);
    path.push(out.slice(0, 3));
  }
  stroke(camera, rect, path, "#0003", 1.5);
  stroke(camera, rect, [...path.slice(0, now + 1), at], "#c2185b", 2);
  const perNewton = 0.07 * view.distance / header.bodies[picked].weight;
  for (const [name, force] of forces(run, time, picked)) {
    const size = Math.hypot(...force) * perNewton, most = 0.25 * view.distance;
    drawArrow(camera, rect, at, scaled(force, perNewton * Math.min(1, most / (size || 1))), forceColors[name]);
  }
}

function describePicked(time) {
  const span = Math.min(header.interval, duration) || 1, before = Math.max(0, Math.min(time, duration - span));
  let text = `<b>body ${picked}</b>`;
  for (const run of shown()) {
    const velocity = scaled(add(place(run, before + span, picked), place(run, before, picked), -1), 1 / span);
    const height = place(run, time, picked)[1] - ground;
    text += `<br>${run.name}: ${height.toFixed(2)} m high, ${Math.hypot(...velocity).toFixed(2)} m/s<table>`;
    for (const [name, force] of run.forces ? forces(run, time, picked) : []) {
      const newton = Math.hypot(...force), told = newton < 1 ? `${(1e3 * newton).toPrecision(3)} mN` : `${+newton.toPrecision(3)} N`;
      text += `<tr><td style="color:${forceColors[name]}">➔ ${name}<td>${told}`;
    }
    text += "</table>";
  }
  element("picked").innerHTML = text;
}
