// SPDX-License-Identifier: Apache-2.0
// Where on a picture of that size a camera sees a point of the scene, from its top left corner.
export function pixelOf(point, camera, width, height) {
  camera.updateMatrixWorld();
  const at = point.clone().project(camera);
  return [((at.x + 1) / 2) * width, ((1 - at.y) / 2) * height];
}
