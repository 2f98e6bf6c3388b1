// SPDX-License-Identifier: Apache-2.0
// Where a pinhole camera sees a point, by its position, target and angle alone: what the picture is compared with.
// `target`: that it looks at, z up; `fov_deg`: of its height. The pixel from the top left corner.
export function pinholePixel({ position, target, fov_deg, width, height }, point) {
  const minus = (a, b) => a.map((value, i) => value - b[i]), dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => a.map((value) => value / Math.hypot(...a));
  const ahead = unit(minus(target, position)), right = unit(cross(ahead, [0, 0, 1])), up = cross(right, ahead);
  const ray = minus(point, position), scale = height / 2 / Math.tan((fov_deg * Math.PI) / 360) / dot(ray, ahead);
  return [width / 2 + scale * dot(ray, right), height / 2 - scale * dot(ray, up)];
}
