// SPDX-License-Identifier: Apache-2.0
// A machine as nested frames. Every group's matrix is the motion of one joint in the machine frame M, so whatever hangs
// in it is drawn where it is with every joint at zero.
import { Matrix4, Object3D, Vector3 } from "three";

// The motion of a screw by `value`, mm or rad, as a matrix of M.
export function screwMotion(screw, value, matrix = new Matrix4()) {
  const [x, y, z] = screw.direction;
  if (!screw.rotary) return matrix.makeTranslation(x * value, y * value, z * value);
  matrix.makeRotationAxis(new Vector3(x, y, z), value);
  const point = new Vector3(...screw.point);
  const moved = point.clone().applyMatrix4(matrix);
  return matrix.setPosition(point.sub(moved));
}

function chainOf(screws, base) {
  const groups = [];
  let parent = base;
  for (const screw of screws) {
    const group = new Object3D();
    group.matrixAutoUpdate = false;
    parent.add(group);
    groups.push(group);
    parent = group;
  }
  return groups;
}

export class Frames {
  constructor(scene) {
    this.scene = scene;
    this.base = new Object3D();
    this.head = chainOf(scene.head, this.base);
    this.table = chainOf(scene.table, this.base);
    const { rotation: r, origin: o } = scene.frame;
    this.workpiece = new Object3D();
    this.workpiece.matrixAutoUpdate = false;
    this.workpiece.matrix.set(
      r[0], r[1], r[2], o[0], r[3], r[4], r[5], o[1], r[6], r[7], r[8], o[2], 0, 0, 0, 1);
    (this.table.at(-1) ?? this.base).add(this.workpiece);
    this.tip = new Object3D();
    (this.head.at(-1) ?? this.base).add(this.tip);
    this.setTool(scene.tool_length);
    this.setJoints(scene.joints.map((joint) => joint.home));
  }

  setTool(length) {
    this.toolLength = length;
    const [gx, gy, gz] = this.scene.gauge;
    const [kx, ky, kz] = this.scene.axis;
    this.tip.position.set(gx - length * kx, gy - length * ky, gz - length * kz);
  }

  setJoints(joints) {
    this.scene.head.forEach((s, i) => screwMotion(s, joints[s.joint], this.head[i].matrix));
    this.scene.table.forEach((s, i) => screwMotion(s, joints[s.joint], this.table[i].matrix));
    this.base.updateMatrixWorld(true);
  }

  tipInScene() {
    return new Vector3().setFromMatrixPosition(this.tip.matrixWorld);
  }

  // Tip and tool axis in the workpiece frame, of the pictures' own transforms.
  pose() {
    const toWorkpiece = this.workpiece.matrixWorld.clone().invert();
    const tip = this.tipInScene().applyMatrix4(toWorkpiece);
    const axis = new Vector3(...this.scene.axis)
      .transformDirection(this.tip.matrixWorld)
      .transformDirection(toWorkpiece);
    return { tip: tip.toArray(), axis: axis.toArray() };
  }
}

// The point of a screw's line that is next to `point`.
export function nearestOnAxis(screw, point) {
  const direction = new Vector3(...screw.direction);
  const from = new Vector3(...screw.point);
  return from.addScaledVector(direction, point.clone().sub(from).dot(direction));
}
