// Vectors, and 4x4 matrices column by column as WebGL has them. World: x east, y north, z up; the ground has radius 1.

export const RAD = Math.PI / 180;

export const towards = (azimuth, elevation, length = 1) => [
  length * Math.sin(azimuth * RAD) * Math.cos(elevation * RAD),
  length * Math.cos(azimuth * RAD) * Math.cos(elevation * RAD),
  length * Math.sin(elevation * RAD),
];
export const add = (a, b, factor = 1) => [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
export const times = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = (a) => times(a, 1 / Math.hypot(...a));

// A body whose own axes lie along x, y and z, their lengths its size, about a point.
export const placed = (x, y, z, at) => [...x, 0, ...y, 0, ...z, 0, ...at, 1];

export function product(a, b) {
  const out = new Array(16);
  for (let column = 0; column < 4; column += 1) {
    for (let row = 0; row < 4; row += 1) {
      let sum = 0;
      for (let index = 0; index < 4; index += 1) sum += a[index * 4 + row] * b[column * 4 + index];
      out[column * 4 + row] = sum;
    }
  }
  return out;
}

export const moved = (m, [x, y, z]) => [
  m[0] * x + m[4] * y + m[8] * z + m[12],
  m[1] * x + m[5] * y + m[9] * z + m[13],
  m[2] * x + m[6] * y + m[10] * z + m[14],
];

// A point in clip space, all four coordinates.
export const clipped = (m, p) => [...moved(m, p), m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15]];

export function looking(eye, at) {
  const back = unit(add(eye, at, -1));
  const right = unit(cross([0, 0, 1], back));
  const up = cross(back, right);
  return [right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
    -dot(right, eye), -dot(up, eye), -dot(back, eye), 1];
}

// A perspective of an upright field of view, degrees.
export function lens(fieldDeg, aspect, near, far) {
  const scale = 1 / Math.tan((fieldDeg * RAD) / 2);
  return [scale / aspect, 0, 0, 0, 0, scale, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
}
