// SPDX-License-Identifier: Apache-2.0
// The cone about the direction of the tool axis in which a joint has no direction of its own (docs/kinematics.md): at the tip,
// about the axis of that joint. Machines with a pole have it in the workpiece frame. A robot's is the axis of its fourth joint:
// along it the roll of a spherical wrist, or the pitch of one of two axes, turns the tool about itself.
import { Vector3 } from "three";
import { plainMaterial } from "./materials.js";

const kHalf_rad = 0.05, kWristJoint = 3;
const kCalm = 0.12, kAtPole = 0.5;

// Where it hangs and its axis there, unit; undefined: the machine has none.
function axisOf({ scene, frames }) {
  if (scene.redundant_joint >= 0) return { carrier: frames.workpiece, axis: new Vector3(...scene.pole) };
  if (scene.family !== "robot") return undefined;
  return { carrier: frames.head[kWristJoint], axis: new Vector3(...scene.head[kWristJoint].direction) };
}

// The cone of `machine` (machine.js), or undefined.
export function coneOf(machine) {
  const found = axisOf(machine);
  return found && new Cone(machine, found);
}

class Cone {
  constructor(machine, { carrier, axis }) {
    this.machine = machine;
    this.axis = axis;
    this.material = plainMaterial(0xf5a524, kCalm);
    this.body = machine.solids.cone(kHalf_rad, 1.3 * machine.size, this.material);
    carrier.add(this.body);
    this.follow();
  }

  // The machine has moved: the tip to the tip, open to the side on which the shank is.
  follow() {
    const { frames, scene } = this.machine, { body, axis } = this;
    const toCarrier = body.parent.matrixWorld.clone().invert();
    const shank = new Vector3(...scene.axis).transformDirection(frames.tip.matrixWorld).transformDirection(toCarrier);
    const side = axis.clone().multiplyScalar(shank.dot(axis) < 0 ? -1 : 1);
    body.quaternion.setFromUnitVectors(new Vector3(0, -1, 0), side);
    body.position.copy(frames.tipInScene().applyMatrix4(toCarrier));
    body.updateMatrixWorld(true);
  }

  setAtPole(isAtPole) {
    this.material.uniforms.opacity.value = isAtPole ? kAtPole : kCalm;
  }
}
