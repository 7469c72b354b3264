// The camera: where it looks, and from where.

const view = {};
function resetView() {
  const from = add(header.eye, header.target, -1);
  view.target = header.target.slice();
  view.distance = Math.hypot(...from);
  view.turn = Math.atan2(from[0], from[2]);
  view.tilt = Math.asin(from[1] / view.distance);
}
resetView();

/** Where the camera is, its axes, and the matrix to clip coordinates of a viewport, column by column. */
function cameraOf(rect) {
  const { width, height } = rect, { distance, turn, tilt } = view, target = targetOf(rect);
  const back = [Math.cos(tilt) * Math.sin(turn), Math.sin(tilt), Math.cos(tilt) * Math.cos(turn)];
  const eye = add(target, back, distance), ahead = scaled(back, -1);
  const right = unit(cross(ahead, [0, 1, 0])), up = cross(right, ahead);
  // The field of view is that of the shorter side, so that narrow viewports lose nothing.
  const focal = 1 / Math.tan(header.fieldOfView / 2), shorter = Math.min(width, height);
  const near = 0.02 * distance, far = 20 * distance + 50, depth = (far + near) / (far - near);
  const rows = [scaled(right, focal * shorter / width), scaled(up, focal * shorter / height), scaled(ahead, depth), ahead];
  const matrix = new Float32Array(16);
  rows.forEach((row, i) => {
    for (let k = 0; k < 3; k++) matrix[4 * k + i] = row[k];
    matrix[12 + i] = -dot(row, eye);
  });
  matrix[14] -= 2 * far * near / (far - near);
  return { eye, right, up, matrix };
}

/** Pixels of the page, and depth; null for what is behind. */
function projected(camera, rect, p) {
  const m = camera.matrix, clip = i => m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i];
  const w = clip(3);
  if (w <= 0.01 * view.distance) return null;
  return [rect.x + (0.5 + 0.5 * clip(0) / w) * rect.width, rect.y + (0.5 - 0.5 * clip(1) / w) * rect.height, w];
}
