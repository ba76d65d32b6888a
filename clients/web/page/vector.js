// Vectors of three numbers, quaternions (w, x, y, z) and 4 by 4 matrices (columns first).

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                a[0] * b[1] - a[1] * b[0]];
export const length = a => Math.sqrt(dot(a, a));
export const mix = (a, b, share) => add(scale(a, 1 - share), scale(b, share));
export const clamp = (value, least, most) => Math.min(most, Math.max(least, value));
export const wrapAngle = angle => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));

export function normalized(a, otherwise = [1, 0, 0]) {
  const long = length(a);
  return long > 1e-9 ? scale(a, 1 / long) : otherwise;
}

// Three axes of length 1 with the third along `direction`.
export function axesAlong(direction) {
  const z = normalized(direction, [0, 0, 1]);
  const x = normalized(cross(Math.abs(z[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0], z));
  return [x, cross(z, x), z];
}

// The axes of a body that a quaternion turns.
export function axesOf({ w, x, y, z }) {
  return [[1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
          [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
          [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]];
}

export const turnZ = angle => [[Math.cos(angle), Math.sin(angle), 0],
                               [-Math.sin(angle), Math.cos(angle), 0], [0, 0, 1]];
export const turnY = angle => [[Math.cos(angle), 0, -Math.sin(angle)], [0, 1, 0],
                               [Math.sin(angle), 0, Math.cos(angle)]];
// The point with those coordinates along the axes.
export const along = (axes, p) => add(add(scale(axes[0], p[0]), scale(axes[1], p[1])),
                                      scale(axes[2], p[2]));
// The axes `inner`, which are given along `outer`, in the frame of `outer`.
export const turned = (outer, inner) => inner.map(axis => along(outer, axis));

// Between two quaternions that are near each other.
export function between(a, b, share) {
  const sign = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0 ? -1 : 1;
  const of = key => (1 - share) * a[key] + sign * share * b[key];
  const q = { w: of('w'), x: of('x'), y: of('y'), z: of('z') };
  const long = Math.hypot(q.w, q.x, q.y, q.z) || 1;
  return { w: q.w / long, x: q.x / long, y: q.y / long, z: q.z / long };
}

export function multiply(a, b) {
  const out = new Float32Array(16);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      let sum = 0;
      for (let i = 0; i < 4; ++i) sum += a[4 * i + row] * b[4 * column + i];
      out[4 * column + row] = sum;
    }
  }
  return out;
}

export function perspective(verticalField, aspect, near, far) {
  const f = 1 / Math.tan(verticalField / 2), out = new Float32Array(16);
  out[0] = f / aspect;
  out[5] = f;
  out[10] = (far + near) / (near - far);
  out[11] = -1;
  out[14] = 2 * far * near / (near - far);
  return out;
}

export function lookAt(eye, target) {
  const back = normalized(sub(eye, target)), right = normalized(cross([0, 0, 1], back));
  const up = cross(back, right), out = new Float32Array(16);
  [right, up, back].forEach((axis, row) => {
    for (let i = 0; i < 3; ++i) out[4 * i + row] = axis[i];
    out[12 + row] = -dot(axis, eye);
  });
  out[15] = 1;
  return out;
}
