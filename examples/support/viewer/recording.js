// What is recorded: poses and forces out of the page's bytes.

const element = id => document.getElementById(id);
const header = JSON.parse(element("header").textContent);
const bytes = decoded(element("data").textContent);
const bodyCount = header.bodies.length, lastFrame = header.frames - 1, duration = lastFrame * header.interval;
const ground = header.ground ?? header.low[1];
const runs = header.runs.map(run => ({
  name: run.name,
  poses: new Uint16Array(bytes.buffer, run.poses, header.frames * bodyCount * 6),
  forces: run.forces === null ? null
    : new Int16Array(bytes.buffer, run.forces, header.frames * bodyCount * 3 * header.components.length),
}));
document.title = header.title;

function decoded(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const raw = atob(text.trim()), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

// A body's pose at a time.

/** Writes x, y, z and the quaternion x, y, z, w of a recorded frame; html.rs describes the six words. */
function key(run, frame, body, out) {
  const words = run.poses, at = (frame * bodyCount + body) * 6;
  for (let k = 0; k < 3; k++) out[k] = header.low[k] + header.size[k] * words[at + k] / 65535;
  const greatest = words[at + 3] >> 15 | words[at + 4] >> 15 << 1;
  let rest = 1;
  for (let k = 0; k < 3; k++) {
    const x = ((words[at + 3 + k] & 32767) / 32767 * 2 - 1) * Math.SQRT1_2;
    out[3 + (greatest + 1 + k) % 4] = x;
    rest -= x * x;
  }
  out[3 + greatest] = Math.sqrt(Math.max(rest, 0));
}

const early = new Float64Array(7), late = new Float64Array(7);

/** The same between frames: places along a line, attitudes along the shorter arc. */
function pose(run, time, body, out, offset = 0) {
  const at = Math.min(time / header.interval || 0, lastFrame), frame = Math.min(Math.floor(at), Math.max(lastFrame - 1, 0));
  const s = at - frame;
  key(run, frame, body, early);
  key(run, Math.min(frame + 1, lastFrame), body, late);
  let same = 0, square = 0;
  for (let k = 3; k < 7; k++) same += early[k] * late[k];
  const sign = same < 0 ? -s : s;
  for (let k = 0; k < 3; k++) out[offset + k] = early[k] + (late[k] - early[k]) * s;
  for (let k = 3; k < 7; k++) square += (out[offset + k] = early[k] * (1 - s) + late[k] * sign) ** 2;
  const length = Math.sqrt(square);
  for (let k = 3; k < 7; k++) out[offset + k] /= length;
}

const place = (run, time, body) => { const out = []; pose(run, time, body, out); return out.slice(0, 3); };

/** Components of the force at the nearest frame, N: [name, vector]. */
function forces(run, time, body) {
  const weight = header.bodies[body].weight, direction = unit(header.gravity);
  const all = [["weight", scaled(direction, weight)]];
  if (!run.forces) return all;
  const frame = Math.min(Math.round(time / header.interval || 0), lastFrame), count = header.components.length;
  header.components.forEach((name, i) => {
    const at = ((frame * bodyCount + body) * count + i) * 3, unit = weight * header.mostWeights / 32767;
    all.push([name, scaled(run.forces.subarray(at, at + 3), unit)]);
  });
  return all;
}
const forceColors = { weight: "#666", drag: "#d32f2f", lift: "#1e5ac8", "added mass": "#e08a00", buoyancy: "#00897b", thrust: "#8e24aa" };

/** Whether the camera goes with the body that is picked: in each viewport with that of its run. */
const follows = () => picked >= 0 && element("follow").checked;

/** What the camera of a viewport looks at. */
const targetOf = ({ run }) => follows() ? place(run, state.time, picked) : view.target;
