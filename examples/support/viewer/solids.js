// Drawing in space: WebGL 2, one call for all bodies of a shape.

const scene = element("scene"), overlay = element("overlay"), paint = overlay.getContext("2d");
// Smooth edges are dear where a processor draws them.
const wanted = { alpha: false, stencil: true };
const gl = scene.getContext("webgl2", { ...wanted, failIfMajorPerformanceCaveat: true })
  ?? scene.getContext("webgl2", { ...wanted, antialias: false });
if (!gl) {
  element("bar").textContent = "This page needs WebGL 2, which this browser does not have or has switched off.";
  throw new Error("no WebGL 2");
}

const program = (vertex, fragment) => {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, "#version 300 es\nprecision highp float;\n" + source);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  }
  gl.linkProgram(made);
  const uniforms = new Proxy({}, { get: (known, name) => known[name] ??= gl.getUniformLocation(made, name) });
  return { made, uniforms };
};

// Shadows are the same triangles, moved along the light onto the ground; of higher bodies they are fainter, as under a wide sky.
const solids = program(`
layout(location = 0) in vec3 vertex;
layout(location = 1) in vec3 place;
layout(location = 2) in vec4 turn;
layout(location = 3) in vec3 color;
uniform mat4 camera;
uniform vec3 light;
uniform float ground, strength;
out vec3 world, tint;
out float shade;
void main() {
  world = place + vertex + 2.0 * cross(turn.xyz, cross(turn.xyz, vertex) + turn.w * vertex);
  tint = pow(color, vec3(1.0 / 2.2));
  shade = strength / (1.0 + 4.0 * max(place.y - ground, 0.0));
  if (strength > 0.0) world -= light * (max(world.y - ground, 0.0) / light.y);
  gl_Position = camera * vec4(world, 1.0);
}`, `
in vec3 world, tint;
in float shade;
uniform vec3 light;
uniform float strength;
out vec4 pixel;
void main() {
  if (strength > 0.0) { pixel = vec4(0.16, 0.12, 0.08, shade); return; }
  // Triangles are flat; derivatives along the screen make a normal that faces the eye.
  vec3 normal = normalize(cross(dFdx(world), dFdy(world)));
  float bright = 0.45 + 0.35 * max(dot(normal, light), 0.0) + 0.2 * abs(normal.y);
  pixel = vec4(tint * pow(bright, 1.0 / 2.2), 1.0);
}`);
const lines = program(`
layout(location = 0) in vec3 vertex;
uniform mat4 camera;
void main() { gl_Position = camera * vec4(vertex, 1.0); }`, `
out vec4 pixel;
void main() { pixel = vec4(0.0, 0.0, 0.0, 0.16); }`);

function buffer(target, data, usage = gl.STATIC_DRAW) {
  const made = gl.createBuffer();
  gl.bindBuffer(target, made);
  gl.bufferData(target, data, usage);
  return made;
}
function uploaded(mesh) {
  const vertices = new Float32Array(bytes.buffer, mesh.vertices, 3 * mesh.vertexCount);
  let radius = 0;
  for (let i = 0; i < vertices.length; i += 3) radius = Math.max(radius, Math.hypot(...vertices.subarray(i, i + 3)));
  return {
    radius,
    count: mesh.indexCount,
    vertices: buffer(gl.ARRAY_BUFFER, vertices),
    indices: buffer(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(bytes.buffer, mesh.indices, mesh.indexCount)),
    // Few triangles that do for shadows and from afar.
    outline: mesh.outline ? uploaded(mesh.outline) : null,
  };
}
const meshes = header.meshes.map(uploaded);

/** What shares a mesh is drawn by one call; an instance is x, y, z, a quaternion and a colour. */
const WORDS = 10;
function instances(things) {
  return meshes.flatMap((mesh, index) => {
    const members = things.flatMap((thing, i) => thing.mesh === index ? [i] : []);
    if (members.length === 0) return [];
    const data = new Float32Array(WORDS * members.length);
    members.forEach((i, k) => {
      const { position, turn, color } = things[i];
      data.set([...(position ?? [0, 0, 0]), ...(turn ?? [0, 0, 0, 1]), ...color], WORDS * k);
    });
    const own = buffer(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    return [{ mesh, members, data, own, full: arrayOf(mesh, own), outline: arrayOf(mesh.outline ?? mesh, own) }];
  });
}

function arrayOf(mesh, own) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ARRAY_BUFFER, mesh.vertices);
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.indices);
  gl.bindBuffer(gl.ARRAY_BUFFER, own);
  [[1, 3, 0], [2, 4, 3], [3, 3, 7]].forEach(([location, size, from]) => {
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, size, gl.FLOAT, false, 4 * WORDS, 4 * from);
    gl.vertexAttribDivisor(location, 1);
  });
  return { array, count: mesh.count };
}
const floor = instances(header.fixed.slice(0, 1)), standing = instances(header.fixed.slice(1)), falling = instances(header.bodies);

/** Draws groups in full, or as outlines where `smallest` (m) is more than a body's radius. */
function drawInstances(groups, smallest = 0) {
  for (const group of groups) {
    const { array, count } = group.mesh.radius < smallest ? group.outline : group.full;
    gl.bindVertexArray(array);
    gl.drawElementsInstanced(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0, group.members.length);
  }
}

function moveTo(run, time) {
  for (const group of falling) {
    group.members.forEach((body, k) => {
      pose(run, time, body, group.data, WORDS * k);
      // One alone needs no mark.
      const marked = body === picked && bodyCount > 1;
      group.data.set(marked ? [1, 0.05, 0.4] : header.bodies[body].color, WORDS * k + 7);
    });
    gl.bindBuffer(gl.ARRAY_BUFFER, group.own);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, group.data);
  }
}

// The grid spans where bodies are, by 1, 2 or 5 times a power of ten that makes about six cells of the longer side.
const grid = (() => {
  const [low, high] = header.bounds, size = add(high, low, -1);
  const longer = Math.max(size[0], size[2], 0.5 * size[1], 0.1), power = 10 ** Math.floor(Math.log10(longer / 6));
  const step = power * [1, 2, 5, 10].find(k => k * power >= longer / 6);
  const range = axis => {
    const from = Math.floor(low[axis] / step), to = Math.ceil(high[axis] / step);
    return Array.from({ length: to - from + 1 }, (_, i) => (from + i) * step);
  };
  const up = Math.max(1, Math.ceil((high[1] - ground) / step));
  const heights = Array.from({ length: up + 1 }, (_, i) => ground + i * step);
  return { step, x: range(0), z: range(2), heights, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
})();
const gridEnds = [grid.x[0], grid.x.at(-1), grid.z[0], grid.z.at(-1)];
const gridPoints = [...grid.x.flatMap(x => [x, ground, gridEnds[2], x, ground, gridEnds[3]]),
  ...grid.z.flatMap(z => [gridEnds[0], ground, z, gridEnds[1], ground, z])];
const gridArray = gl.createVertexArray();
gl.bindVertexArray(gridArray);
buffer(gl.ARRAY_BUFFER, new Float32Array(gridPoints));
gl.enableVertexAttribArray(0);
gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);

// Bodies of fewer pixels in diameter are drawn as their outlines: curved ones look no different.
const FINE = 50;

function drawScene(camera, rect, scale, run, time) {
  const y = scene.height - (rect.y + rect.height) * scale;
  gl.viewport(rect.x * scale, y, rect.width * scale, rect.height * scale);
  gl.useProgram(solids.made);
  gl.uniformMatrix4fv(solids.uniforms.camera, false, camera.matrix);
  gl.uniform3fv(solids.uniforms.light, header.light);
  gl.uniform1f(solids.uniforms.ground, ground);
  gl.uniform1f(solids.uniforms.strength, 0);
  gl.enable(gl.DEPTH_TEST);
  moveTo(run, time);
  const fine = FINE * view.distance * Math.tan(header.fieldOfView / 2) / Math.min(rect.width, rect.height);
  const drawBodies = () => {
    gl.useProgram(solids.made);
    drawInstances(standing);
    drawInstances(falling, fine);
  };
  if (header.water) {
    // What is under the water is seen through it; grid and shadows lie on it, behind what is above.
    drawBodies();
    gl.enable(gl.BLEND);
    gl.blendColor(0, 0, 0, 0.6);
    gl.blendFunc(gl.CONSTANT_ALPHA, gl.ONE_MINUS_CONSTANT_ALPHA);
    gl.depthMask(false);
    drawInstances(floor);
    if (camera.eye[1] > ground) drawOnFloor(camera);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    return;
  }
  drawInstances(floor);
  if (camera.eye[1] > ground) {
    // Grid and shadows lie in the floor: they are drawn on it before anything stands on it, without depth.
    gl.disable(gl.DEPTH_TEST);
    drawOnFloor(camera);
    gl.enable(gl.DEPTH_TEST);
  }
  drawBodies();
}

/** The grid and the shadows. */
function drawOnFloor(camera) {
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.useProgram(lines.made);
  gl.uniformMatrix4fv(lines.uniforms.camera, false, camera.matrix);
  gl.bindVertexArray(gridArray);
  gl.drawArrays(gl.LINES, 0, gridPoints.length / 3);
  // Once per pixel: two shadows in one place are no darker than one.
  gl.enable(gl.STENCIL_TEST);
  gl.stencilFunc(gl.EQUAL, 0, 255);
  gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
  gl.useProgram(solids.made);
  gl.uniform1f(solids.uniforms.strength, 0.3);
  // Water ends somewhere, at banks: theirs would fall on nothing.
  if (!header.water) drawInstances(standing);
  drawInstances(falling, Infinity);
  gl.uniform1f(solids.uniforms.strength, 0);
  gl.disable(gl.STENCIL_TEST);
  gl.disable(gl.BLEND);
}
