// SPDX-License-Identifier: Apache-2.0
// How finely a line must be drawn: at each tolerance, the points without which it would be seen to be another line.

const kFinest_mm = 0.002, kStep = 2, kTolerances = 15;
const kWorthwhile = 0.8;

// How far off, in mm, the line is where a point is left out (Douglas and Peucker); a point's is never above that of the
// points that it was found between.
function deviations(position, count) {
  const off = new Float32Array(count);
  off[0] = off[count - 1] = Infinity;
  const open = [[0, count - 1, Infinity]];
  while (open.length > 0) {
    const [first, last, cap] = open.pop();
    const [squared, at] = farthest(position, first, last);
    if (at < 0) continue;
    off[at] = Math.min(cap, Math.sqrt(squared));
    open.push([first, at, off[at]], [at, last, off[at]]);
  }
  return off;
}

// The point between two that lies farthest from their segment: its distance squared and its number, -1 where there is none.
function farthest(position, first, last) {
  const [ax, ay, az] = position.subarray(3 * first, 3 * first + 3);
  const dx = position[3 * last] - ax, dy = position[3 * last + 1] - ay, dz = position[3 * last + 2] - az;
  const length = dx * dx + dy * dy + dz * dz;
  let max = -1, at = -1;
  for (let i = first + 1; i < last; ++i) {
    const px = position[3 * i] - ax, py = position[3 * i + 1] - ay, pz = position[3 * i + 2] - az;
    const share = length > 0 ? Math.min(Math.max((px * dx + py * dy + pz * dz) / length, 0), 1) : 0;
    const x = px - share * dx, y = py - share * dy, z = pz - share * dz;
    const squared = x * x + y * y + z * z;
    if (squared > max) [max, at] = [squared, i];
  }
  return [max, at];
}

// Where the colour changes, both points count as much as the shorter of the two stretches is long.
function keepColours(position, colour, count, off) {
  const along = new Float64Array(count);
  const changes = [0];
  for (let i = 1, a = 0, b = 3; i < count; ++i, a += 3, b += 3) {
    along[i] = along[i - 1] + Math.hypot(position[b] - position[a], position[b + 1] - position[a + 1], position[b + 2] - position[a + 2]);
    if (colour[a] !== colour[b] || colour[a + 1] !== colour[b + 1] || colour[a + 2] !== colour[b + 2]) changes.push(i);
  }
  changes.push(count - 1);
  for (let c = 1; c + 1 < changes.length; ++c) {
    const at = changes[c];
    const shorter = Math.min(along[at] - along[changes[c - 1]], along[changes[c + 1]] - along[at]);
    off[at] = Math.max(off[at], shorter);
    off[at - 1] = Math.max(off[at - 1], shorter);
  }
}

export class Detail {
  // `position`, `colour`: three numbers of each point; at most 65536 points.
  constructor(position, colour, count) {
    const off = deviations(position, count);
    keepColours(position, colour, count, off);
    this.levels = [];
    let before = count;
    for (let k = 0, tolerance = kFinest_mm; k < kTolerances; ++k, tolerance *= kStep) {
      const kept = Uint16Array.from({ length: count }, (_, i) => i).filter((i) => off[i] > tolerance);
      if (kept.length > kWorthwhile * before) continue;
      before = kept.length;
      this.levels.push({ tolerance, points: kept });
    }
  }

  // The points to draw where `tolerance` millimetres are not seen; null: all of them.
  at(tolerance) {
    return this.levels.findLast((level) => level.tolerance <= tolerance)?.points ?? null;
  }
}
