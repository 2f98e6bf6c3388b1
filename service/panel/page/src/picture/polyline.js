// SPDX-License-Identifier: Apache-2.0
// A long line as one thing, whose stretches are drawn as finely as their distance from the camera asks for.
import { Box3, BufferAttribute, BufferGeometry, Frustum, Line, Matrix4, Sphere } from "three";
import { Detail } from "./detail.js";
import { lineMaterial } from "./materials.js";

export const kStretch = 4096;
const kSeen_px = 0.5, kMaxRanges = 256;

// What that camera has in its picture.
const seenBy = (camera) =>
  new Frustum().setFromProjectionMatrix(new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));

// These numbers go to the graphics card with the next picture. A hidden tab draws none: its ranges become one.
export function mark(attribute, from, count) {
  const { updateRanges } = attribute;
  if (updateRanges.length >= kMaxRanges) {
    const first = Math.min(...updateRanges.map(({ start }) => start));
    const end = Math.max(...updateRanges.map((one) => one.start + one.count));
    attribute.clearUpdateRanges();
    attribute.addUpdateRange(first, end - first);
  }
  attribute.addUpdateRange(from, count);
  attribute.needsUpdate = true;
}

const material = lineMaterial();

export class Polyline {
  constructor(capacity) {
    const attribute = (array, size, isShare) => new BufferAttribute(array, size, isShare);
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute("position", attribute(new Float32Array(3 * capacity), 3, false));
    this.geometry.setAttribute("color", attribute(new Uint8Array(3 * capacity), 3, true));
    this.index = attribute(new Uint32Array(capacity), 1, false);
    this.geometry.setIndex(this.index);
    this.line = new Line(this.geometry, material);
    this.line.frustumCulled = false;
    this.clear();
  }

  clear() {
    this.count = 0;
    this.stretches = [];
    this.draw(0);
  }

  // The first `count` of these indices are drawn.
  draw(count) {
    this.drawn = count;
    this.geometry.setDrawRange(0, count);
  }

  // All points at once; `colour`: bytes, linear.
  set(position, colour) {
    this.clear();
    this.write(0, position, colour);
    this.count = position.length / 3;
    for (let first = 0; first < this.count; first += kStretch) this.close(first, Math.min(first + kStretch, this.count));
    this.rebuild();
  }

  // One point more, after the last. Only what is new goes to the graphics card.
  add(point, tint) {
    this.write(this.count, point, tint);
    this.index.array[this.drawn] = this.count;
    mark(this.index, this.drawn, 1);
    this.count += 1;
    this.draw(this.drawn + 1);
    if (this.count % kStretch === 0) this.close(this.count - kStretch, this.count);
  }

  write(at, position, colour) {
    const { attributes } = this.geometry;
    for (const [attribute, values] of [[attributes.position, position], [attributes.color, colour]]) {
      attribute.array.set(values, 3 * at);
      mark(attribute, 3 * at, values.length);
    }
  }

  // Nothing is added to that stretch any more.
  close(first, end) {
    const { position, color } = this.geometry.attributes;
    const points = position.array.subarray(3 * first, 3 * end);
    const ball = new Box3().setFromArray(points).getBoundingSphere(new Sphere());
    const detail = new Detail(points, color.array.subarray(3 * first, 3 * end), end - first);
    this.stretches.push({ end, ball, detail, ends: [0, end - first - 1], level: null });
  }

  // Its first `count` points go, whole stretches.
  drop(count) {
    const { position, color } = this.geometry.attributes;
    for (const attribute of [position, color]) {
      attribute.array.copyWithin(0, 3 * count);
      mark(attribute, 0, 3 * (this.count - count));
    }
    this.count -= count;
    this.stretches = this.stretches.slice(count / kStretch).map((one) => ({ ...one, end: one.end - count }));
    this.rebuild();
  }

  // Before each picture; `pixel`: the angle that one has. Of a stretch outside the picture its ends are
  // enough: what joins them is outside too.
  setDetail(camera, pixel) {
    const ball = new Sphere(), seen = seenBy(camera);
    let isChanged = false;
    for (const stretch of this.stretches) {
      const { center, radius } = ball.copy(stretch.ball).applyMatrix4(this.line.matrixWorld);
      const near_mm = Math.max(center.distanceTo(camera.position) - radius, camera.near);
      const level = seen.intersectsSphere(ball) ? stretch.detail.at(kSeen_px * pixel * near_mm) : stretch.ends;
      isChanged ||= level !== stretch.level;
      stretch.level = level;
    }
    if (isChanged) this.rebuild();
  }

  rebuild() {
    const { array } = this.index;
    let drawn = 0, first = 0;
    for (const { end, level } of this.stretches) {
      if (level) for (const i of level) array[drawn++] = first + i;
      else for (let i = first; i < end; ++i) array[drawn++] = i;
      first = end;
    }
    for (let i = first; i < this.count; ++i) array[drawn++] = i;
    mark(this.index, 0, drawn);
    this.draw(drawn);
  }

  // Where a ray meets it, of all its points: `hit.index` is the point's number.
  pick(raycaster) {
    this.geometry.setIndex(null);
    this.geometry.setDrawRange(0, this.count);
    this.geometry.boundingSphere = null;
    const [hit] = raycaster.intersectObject(this.line, false);
    this.geometry.setIndex(this.index);
    this.draw(this.drawn);
    return hit;
  }

  dispose() {
    this.line.removeFromParent();
    this.geometry.dispose();
  }
}
