// SPDX-License-Identifier: Apache-2.0
// The two sliders of an actuator stage and what joins them to the table (docs/kinematics.md, chapter 3).
import { Vector3 } from "three";

// Where slider and pin of side `k` (0, 1) are: along the slide, and across it. The slide's own coordinates.
function sliderAt(stage, joints, k) {
  const s = stage.sign_s * joints[stage.linear] + stage.offset_s;
  const phi = stage.sign_phi * joints[stage.rotary] + stage.offset_phi;
  const sign = k === 0 ? -1 : 1;
  if (stage.kind === "pin_slot") {
    const pull = stage.rail * Math.tan(phi);
    return { slider: s + sign * pull, pin: s + sign * pull, across: -sign * stage.rail, pinAcross: -sign * stage.rail };
  }
  const reach = stage.radius * Math.cos(phi) - stage.rail;
  const rod = Math.sqrt(Math.max(0, (stage.rod - reach) * (stage.rod + reach)));
  const pin = s + sign * stage.radius * Math.sin(phi);
  return { slider: pin - stage.sides[k] * rod, pin, across: -sign * stage.rail, pinAcross: -sign * stage.radius * Math.cos(phi) };
}

// Draws the stage of `machine` and returns who moves it with the joints; undefined where there is none.
export function drawStage(machine) {
  const { scene, solids, root, size } = machine;
  const stage = scene.stage;
  if (!stage) return undefined;
  const slide = scene.table.find((screw) => screw.joint === stage.linear) ?? scene.head.find((screw) => screw.joint === stage.linear);
  if (!slide) return undefined;
  // The slide runs against its joint where sign_s is -1; across is a quarter turn from it.
  const along = new Vector3(...slide.direction).multiplyScalar(stage.sign_s);
  const across = new Vector3(-along.y, along.x, 0).normalize();
  const level = scene.frame.origin[2] - 0.75 * size;
  const point = (a, c) => new Vector3(0, 0, level).addScaledVector(along, a - stage.offset_s).addScaledVector(across, c);
  const parts = [0, 1].map((k) => {
    const [low, high] = stage.drives[k].travel;
    const rest = sliderAt(stage, scene.joints.map((joint) => joint.home), k);
    root.add(solids.beam(point(low - 0.3 * size, rest.across), point(high + 0.3 * size, rest.across), 0.1 * size, "holder"));
    const slider = solids.box(new Vector3(), [0.4 * size, 0.4 * size, 0.24 * size], "accent");
    const pin = solids.cylinder(new Vector3(), new Vector3(0, 0, 1), 0.07 * size, 0.5 * size, "tool");
    const rod = solids.beam(new Vector3(), new Vector3(0, 1, 0), 0.11 * size, "moving");
    for (const part of [slider, pin, rod]) part.userData.isLoose = true;
    root.add(slider, pin, rod);
    return { slider, pin, rod };
  });
  return (joints) => {
    parts.forEach(({ slider, pin, rod }, k) => {
      const at = sliderAt(stage, joints, k);
      const from = point(at.slider, at.across), to = point(at.pin, at.pinAcross);
      slider.position.copy(from);
      pin.position.copy(to);
      const reach = to.clone().sub(from);
      const length = reach.length();
      rod.position.copy(from).addScaledVector(reach, 0.5);
      rod.scale.set(1, Math.max(length, 1e-6), 1);
      if (length < 1e-6) return;
      rod.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), reach.normalize());
    });
    root.updateMatrixWorld(true);
  };
}
