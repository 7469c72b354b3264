// The physics: the module, and what the renderer wants to know of the scene that it holds.

const element = id => document.getElementById(id);
const raw = atob(element("module").textContent.trim());
const { instance } = await WebAssembly.instantiate(Uint8Array.from(raw, c => c.charCodeAt(0)));
const physics = instance.exports;
const FLOOR = 1.5, COLORS = [
  [[0.55, 0.16, 0.02], [0.70, 0.33, 0.03], [0.42, 0.06, 0.03], [0.62, 0.48, 0.06], [0.26, 0.30, 0.06]],
  [[0.80, 0.79, 0.75], [0.60, 0.05, 0.06], [0.06, 0.10, 0.35]],
  [[0.05, 0.30, 0.65], [0.75, 0.08, 0.30], [0.85, 0.70, 0.08], [0.06, 0.45, 0.22]],
  [[0.62, 0.46, 0.16], [0.50, 0.50, 0.52]],
];

const kinds = physics.start(7, 1), most = physics.most(), bodyCount = kinds * most;
if (kinds === 0) throw new Error("the scene could not be made");

// Meshes lie one behind the other in a buffer of their own: the module's memory may move.
const parts = [];
let size = 0;
function put(numbers) {
  parts.push([size, numbers]);
  size += numbers.byteLength;
  return size - numbers.byteLength;
}
function mesh(vertices, indices) {
  return { vertices: put(vertices), vertexCount: vertices.length / 3, indices: put(indices), indexCount: indices.length };
}
const memory = () => physics.memory.buffer;
const solidsOfKinds = Array.from({ length: kinds }, (_, kind) => mesh(
  new Float32Array(memory(), physics.vertices(kind), 3 * physics.vertex_count(kind)),
  new Uint32Array(memory(), physics.indices(kind), physics.index_count(kind))));
const corners = [[-1, -1], [-1, 1], [1, 1], [1, -1]].flatMap(([x, z]) => [FLOOR * x, 0, FLOOR * z]);
solidsOfKinds.push(mesh(new Float32Array(corners), new Uint32Array([0, 1, 2, 0, 2, 3])));
const bytes = new Uint8Array(size);
for (const [at, numbers] of parts) bytes.set(new Uint8Array(numbers.buffer, numbers.byteOffset, numbers.byteLength), at);

const header = {
  meshes: solidsOfKinds,
  fixed: [{ mesh: kinds, color: [0.62, 0.60, 0.56] }],
  bodies: Array.from({ length: bodyCount }, (_, body) => {
    const kind = Math.floor(body / most);
    return { mesh: kind, color: COLORS[kind][body * 7 % COLORS[kind].length] };
  }),
  bounds: [[-FLOOR, 0, -FLOOR], [FLOOR, 1.5, FLOOR]],
  light: [0.35, 0.86, 0.37],
  fieldOfView: 0.7,
  target: [0, 0.45, 0],
  eye: [1.2, 1.5, 2.9],
};
const ground = 0, picked = -1;

/** The pose of a body after the last step. */
function pose(run, time, body, out, offset = 0) {
  for (let k = 0; k < 7; k++) out[offset + k] = run.poses[7 * body + k];
}

/** What the camera looks at. */
const targetOf = () => view.target;
