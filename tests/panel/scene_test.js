// SPDX-License-Identifier: Apache-2.0
// The picture's tip and tool axis equal forward() for every shipped machine file and a hundred poses each, and a camera sees the
// tip at the pixel of a pinhole.
import { execFileSync } from "node:child_process";
import { BoxGeometry, PerspectiveCamera, Vector3 } from "three";
import { pixelOf } from "../../service/panel/page/src/picture/pixel.js";
import { Frames } from "../../service/panel/page/src/picture/screws.js";
import { coneOf } from "../../service/panel/page/src/picture/cone.js";
import { Machine } from "../../service/panel/page/src/picture/machine.js";
import { pinholePixel } from "./pinhole.mjs";

const kTip_mm = 1e-6; // reach 5e3 mm * eps = 1e-12, a million times
const kAxis = 1e-9;
const kPixels = 2;
const kMinMachines = 10;
const kRoll = 3; // of a robot: the fourth joint
const [cases, machines] = process.argv.slice(4);
const text = execFileSync(cases, [machines], { encoding: "utf8", maxBuffer: 1 << 28 });
const distance = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));

// A body that hangs on a joint is carried by it and by those below it: where the drawn tip goes, one at the tip goes too.
function meshesHangWhereTheySay(scene, poses) {
  const machine = new Machine(scene, "dark");
  const drawnOf = () => { let count = 0; machine.root.traverse((one) => (count += one.userData.edges ? 1 : 0)); return count; };
  const before = drawnOf(), last = scene.head.at(-1);
  if (!last) return true;
  machine.setTool(poses[0].tool);
  const tipAtZero = machine.frames.tip.position.clone();
  machine.addMesh(scene.joints[last.joint].name, new BoxGeometry(1, 1, 1).translate(...tipAtZero.toArray()));
  machine.addMesh("part", new BoxGeometry(1, 1, 1));
  machine.addMesh("no such link", new BoxGeometry(1, 1, 1));
  const fromFile = (one) => one.userData.faces && !one.userData.edges;
  const body = machine.frames.head.at(-1).children.find(fromFile);
  const blank = machine.frames.workpiece.children.find(fromFile);
  // The faces that are drawn know the frames of both.
  const isCarried = [body, blank].every((one) => one && machine.bodies.frames.value.includes(one.parent.matrixWorld));
  return isCarried && drawnOf() < before && poses.every(({ joints }) => {
    machine.setJoints(joints);
    const at = new Vector3(...tipAtZero.toArray()).applyMatrix4(body.matrixWorld);
    return at.distanceTo(new Vector3().setFromMatrixPosition(machine.frames.tip.matrixWorld)) <= kTip_mm;
  });
}

// How many pixels the drawn tip is from where a pinhole sees the one of forward(), for one of several cameras.
function pixelsOff(frames, pose, number) {
  const view = { position: [[2500, -3100, 1900], [0, -4000, 50], [4000, 0, 900], [10, -20, 4500]][number % 4], target: [0, 0, 100], fov_deg: 32, width: 1280, height: 720 };
  const camera = new PerspectiveCamera(view.fov_deg, view.width / view.height, 1, 50000);
  camera.up.set(0, 0, 1);
  camera.position.set(...view.position);
  camera.lookAt(...view.target);
  const drawn = pixelOf(frames.tipInScene(), camera, view.width, view.height);
  const tip = new Vector3(...pose.tip).applyMatrix4(frames.workpiece.matrixWorld);
  return distance(drawn, pinholePixel(view, tip.toArray()));
}

const kParallel = 1e-6; // rad; the scan ends in steps of 1e-9

// Where the tool axis lies in the cone's axis, turning the joint that has no direction there leaves it where it is.
function coneIsWhereAJointHasNoDirection(scene, { joints, tool }) {
  const machine = new Machine(scene, "dark"), { frames } = machine, cone = coneOf(machine);
  if (!cone) return false;
  frames.setTool(tool);
  const free = scene.redundant_joint >= 0 ? scene.redundant_joint : kRoll;
  const tilts = [...scene.head, ...scene.table].filter(({ joint, rotary }) => rotary && joint !== free);
  const tilt = tilts.map(({ joint }) => joint).find((joint) => scene.family !== "robot" || joint > free);
  const q = [...joints];
  const offAt = (value) => {
    q[tilt] = value;
    machine.setJoints(q);
    cone.follow();
    return new Vector3(...scene.axis).transformDirection(frames.tip.matrixWorld).angleTo(coneAxis(cone));
  };
  const off = offAt(lowestOf(offAt, -Math.PI, Math.PI)), before = frames.pose();
  const apart = cone.body.getWorldPosition(new Vector3()).distanceTo(frames.tipInScene());
  if (off > kParallel || apart > kTip_mm) return false;
  q[free] += 0.7;
  machine.setJoints(q);
  return distance(frames.pose().axis, before.axis) < kParallel;
}

// From its tip into the cone, in the scene.
const coneAxis = (cone) => new Vector3(0, -1, 0).transformDirection(cone.body.matrixWorld);

// Where `f` is least, by ever finer scans.
function lowestOf(f, low, high) {
  const kSteps = 400, step = (high - low) / kSteps;
  let best = low;
  for (let i = 1; i <= kSteps; ++i) if (f(low + i * step) < f(best)) best = low + i * step;
  return step < 1e-9 ? best : lowestOf(f, best - 2 * step, best + 2 * step);
}

let worstTip = 0, worstAxis = 0, worstPixels = 0, count = 0, failures = 0;
for (const line of text.trim().split("\n")) {
  const { scene, poses } = JSON.parse(line);
  const drawn = new Machine(scene, "dark");
  for (const frames of [new Frames(scene), drawn.frames]) {
    for (const [number, pose] of poses.entries()) {
      frames.setTool(pose.tool);
      frames.setJoints(pose.joints);
      const { tip, axis } = frames.pose();
      const apart = distance(tip, pose.tip), turned = distance(axis, pose.axis);
      worstTip = Math.max(worstTip, apart);
      worstAxis = Math.max(worstAxis, turned);
      const pixels = pixelsOff(frames, pose, number);
      worstPixels = Math.max(worstPixels, pixels);
      if (!(apart <= kTip_mm) || !(turned <= kAxis) || !(pixels <= kPixels)) {
        failures += 1;
        console.log(`${scene.name}: tip off by ${apart} mm and ${pixels} pixels, axis by ${turned}`);
      }
    }
  }
  // Every body of every machine stands somewhere: no NaN reaches the picture.
  drawn.setJoints(poses[0].joints);
  drawn.root.traverse((one) => {
    if (!one.matrixWorld.elements.every(Number.isFinite)) {
      failures += 1;
      console.log(`${scene.name}: a body has no position`);
    }
  });
  if (!meshesHangWhereTheySay(scene, poses)) {
    failures += 1;
    console.log(`${scene.name}: a mesh hangs elsewhere`);
  }
  if (!coneIsWhereAJointHasNoDirection(scene, poses[0])) {
    failures += 1;
    console.log(`${scene.name}: the singular cone is elsewhere`);
  }
  count += 1;
}
console.log(`${count} machines, tip within ${worstTip.toExponential(2)} mm, axis within ${worstAxis.toExponential(2)}, pixels within ${worstPixels.toExponential(2)}`);
process.exit(failures === 0 && count >= kMinMachines ? 0 : 1);
