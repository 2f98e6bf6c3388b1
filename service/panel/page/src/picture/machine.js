// SPDX-License-Identifier: Apache-2.0
// Draws any machine from its screws: from the tool down to the base, then from the workpiece down to it.
import { Vector3 } from "three";
import { Bodies } from "./bodies.js";
import { Frames, nearestOnAxis } from "./screws.js";
import { Solids } from "./shapes.js";
import { drawStage } from "./stage.js";

const kUp = new Vector3(0, 0, 1);
const kBack = new Vector3(0, 1, 0);
const vector = (array) => new Vector3(...array);

// What the sizes of bodies go by: a table that fits the travel.
function sizeOf(scene) {
  const linear = [...scene.head, ...scene.table].filter((screw) => !screw.rotary);
  if (linear.length === 0) {
    const points = scene.head.map((screw) => vector(screw.point));
    return Math.max(60, 0.14 * Math.max(...points.map((p) => p.length())));
  }
  const ranges = linear.map(({ joint }) => scene.joints[joint].travel[1] - scene.joints[joint].travel[0]);
  return Math.min(320, Math.max(60, 0.22 * Math.min(...ranges)));
}

export class Machine {
  constructor(scene, theme) {
    this.scene = scene;
    this.frames = new Frames(scene);
    this.solids = new Solids(theme);
    this.size = sizeOf(scene);
    this.root = this.frames.base;
    this.floor = -1.4 * this.size;
    this.drawTable();
    this.drawHead();
    this.stage = drawStage(this);
    this.bodies = new Bodies(this.solids.colours.edge);
    this.root.add(this.bodies.faces, this.bodies.edges);
    this.drawTool();
    if (scene.tip_box) this.root.add(this.solids.frame(scene.tip_box.min, scene.tip_box.max));
    this.setJoints(scene.joints.map((joint) => joint.home));
  }

  // A body from a file, in the frame M with every joint at zero; what was drawn of its link from the joints alone goes.
  addMesh(link, geometry) {
    const { scene, frames, solids } = this;
    const joint = scene.joints.findIndex(({ name }) => name === link);
    const at = (screws, groups) => groups[screws.findIndex((screw) => screw.joint === joint)];
    const group = link === "part" ? frames.workpiece : link === "base" ? this.root : at(scene.head, frames.head) ?? at(scene.table, frames.table);
    if (!group) return;
    const kept = new Set(link === "part" ? group.children : [this.tool, this.holder]);
    for (const one of [...group.children]) if (one.userData.edges && !kept.has(one)) one.removeFromParent();
    group.add(solids.mesh(geometry, link === "base" ? "body" : link === "part" ? "table" : "moving"));
    this.bodies.rebuild(this.root);
  }

  setJoints(joints) {
    this.frames.setJoints(joints);
    this.stage?.(joints);
  }

  setTool(length) {
    if (Math.abs(length - this.frames.toolLength) < 1e-9) return;
    this.frames.setTool(length);
    this.drawTool();
    this.root.updateMatrixWorld(true);
  }

  drawTool() {
    const { scene, frames, solids } = this;
    this.tool?.removeFromParent();
    const parent = frames.head.at(-1) ?? this.root;
    const axis = vector(scene.axis);
    const gauge = vector(scene.gauge);
    const length = Math.max(frames.toolLength, 1);
    const known = scene.tools.find((tool) => Math.abs(tool.length - frames.toolLength) < 1e-6);
    const radius = Math.max(known?.radius ?? 0.04 * length, 0.5);
    const holder = Math.min(0.4 * length, 0.4 * this.size);
    const at = (from) => gauge.clone().addScaledVector(axis, -from);
    this.tool = solids.cylinder(at((holder + length) / 2), axis, radius, length - holder, "tool");
    const narrow = Math.max(1.6 * radius, 0.06 * this.size);
    this.holder?.removeFromParent();
    this.holder = solids.cylinder(at(holder / 2), axis, narrow, holder, "holder", Math.max(narrow, 0.13 * this.size));
    parent.add(this.tool, this.holder);
    this.bodies.rebuild(this.root);
  }

  groupBelow(groups, i) {
    return i > 0 ? groups[i - 1] : this.root;
  }

  // ---- from the gauge line to the base

  drawHead() {
    const { scene, frames, solids, size } = this;
    const axis = vector(scene.axis);
    let at = vector(scene.gauge);
    const last = frames.head.at(-1) ?? this.root;
    const spindle = 0.62 * size;
    last.add(solids.cylinder(at.clone().addScaledVector(axis, spindle / 2), axis, 0.2 * size, spindle, "moving", 0.24 * size));
    if (!scene.head.at(-1)?.rotary) at.addScaledVector(axis, spindle);
    this.span = 0;
    for (let i = scene.head.length - 1; i >= 0; --i) {
      const screw = scene.head[i];
      at = screw.rotary ? this.drawHeadRotary(i, screw, at) : this.drawHeadLinear(i, screw, at);
    }
    const isArm = scene.head.length > 0 && scene.head[0].rotary;
    if (isArm) this.drawPedestal(at);
  }

  drawHeadRotary(i, screw, at) {
    const { frames, solids, size } = this;
    const direction = vector(screw.direction);
    const anchor = nearestOnAxis(screw, at);
    const inner = frames.head[i];
    if (anchor.distanceTo(at) > 0.05 * size) {
      const isLong = anchor.distanceTo(at) > 1.5 * size;
      inner.add(solids.beam(at, anchor, (isLong ? 0.34 : 0.36) * size, "moving", (isLong ? 0.46 : 0.4) * size));
    }
    inner.add(solids.cylinder(anchor, direction, 0.27 * size, 0.5 * size, "accent"));
    this.groupBelow(frames.head, i).add(solids.cylinder(anchor, direction, 0.22 * size, 0.72 * size, "body"));
    return anchor;
  }

  travelOf(screw) {
    const [low, high] = this.scene.joints[screw.joint].travel;
    return this.scene.joints[screw.joint].endless ? [-500, 500] : [low, high];
  }

  drawHeadLinear(i, screw, at) {
    const direction = vector(screw.direction);
    const [low, high] = this.travelOf(screw);
    if (Math.abs(direction.z) > 0.7) return this.drawRam(i, direction, low, high, at);
    return this.drawBeam(i, direction, low, high, at);
  }

  // A ram through a carriage that stands above its highest position.
  drawRam(i, direction, low, high, at) {
    const { frames, solids, size } = this;
    const up = direction.clone().multiplyScalar(Math.sign(direction.z));
    const [least, most] = direction.z > 0 ? [low, high] : [-high, -low];
    const length = most - least + 1.2 * size;
    const width = 0.5 * size;
    frames.head[i].add(solids.box(at.clone().addScaledVector(up, length / 2), [width, width, length], "moving"));
    const carriage = at.clone().addScaledVector(up, most + 0.6 * size);
    const below = this.groupBelow(frames.head, i);
    below.add(solids.box(carriage, [1.5 * width, 1.5 * width, 0.9 * size], "body"));
    if (i === 0) this.drawColumn(carriage, size);
    return carriage;
  }

  drawColumn(top, size) {
    const back = top.clone().addScaledVector(kBack, 0.9 * size);
    const foot = back.clone().setZ(this.floor);
    this.root.add(this.solids.beam(foot, back.clone().addScaledVector(kUp, 0.45 * size), 0.9 * size, "body"));
    this.root.add(this.solids.beam(back, top, 0.5 * size, "body"));
  }

  // A beam that a carriage runs along; what it stands on hangs on who carries it.
  drawBeam(i, direction, low, high, at) {
    const { frames, solids, size } = this;
    const below = this.groupBelow(frames.head, i);
    const isCarried = i > 0;
    if (!isCarried && this.span > 0) return this.drawPortal(direction, low, high, at);
    const height = 0.7 * size;
    const side = Math.abs(direction.x) > 0.7 ? kBack : new Vector3(1, 0, 0);
    const centre = at.clone().addScaledVector(side, 0.62 * size);
    const from = centre.clone().addScaledVector(direction, low - 0.5 * size);
    const to = centre.clone().addScaledVector(direction, high + 0.5 * size);
    below.add(solids.beam(from, to, height, "body"));
    for (const level of [-0.22, 0.22]) {
      const rail = (point) => point.clone().addScaledVector(side, -0.38 * size).addScaledVector(kUp, level * size);
      below.add(solids.beam(rail(from), rail(to), 0.07 * size, "holder"));
    }
    frames.head[i].add(solids.box(at.clone().addScaledVector(side, 0.14 * size), [0.8 * size, 0.8 * size, 0.8 * size], "accent"));
    this.span = from.distanceTo(to);
    this.spanEnds = [from, to];
    if (!isCarried) {
      for (const end of [from, to]) {
        this.root.add(solids.beam(end.clone().setZ(this.floor), end.clone().addScaledVector(kUp, 0.35 * size), 0.62 * size, "body"));
      }
    }
    return centre;
  }

  // What carries a beam: two legs on rails along the floor.
  drawPortal(direction, low, high, at) {
    const { frames, solids, size } = this;
    for (const end of this.spanEnds) {
      const foot = end.clone().setZ(this.floor + 0.3 * size);
      frames.head[0].add(solids.beam(foot, end.clone().addScaledVector(kUp, 0.35 * size), 0.55 * size, "moving"));
      frames.head[0].add(solids.box(foot, [0.9 * size, 0.9 * size, 0.22 * size], "accent"));
      const rail = end.clone().setZ(this.floor + 0.08 * size);
      this.root.add(solids.beam(rail.clone().addScaledVector(direction, low - 0.6 * size),
        rail.clone().addScaledVector(direction, high + 0.6 * size), 0.3 * size, "body"));
    }
    return at;
  }

  drawPedestal(at) {
    const { solids, size } = this;
    const foot = new Vector3(at.x, at.y, this.floor);
    this.root.add(solids.cylinder(foot.clone().lerp(at, 0.5), kUp, 0.62 * size, at.distanceTo(foot), "body", 0.42 * size));
    this.root.add(solids.box(foot, [2 * size, 2 * size, 0.16 * size], "body"));
  }

  // ---- from the workpiece to the base

  drawTable() {
    const { scene, frames } = this;
    let at = new Vector3(...scene.frame.origin);
    if (scene.table.length === 0) return this.drawFixedTable(at);
    this.isPlatter = false;
    for (let i = scene.table.length - 1; i >= 0; --i) {
      const screw = scene.table[i];
      at = screw.rotary ? this.drawTableRotary(i, screw, at) : this.drawSlide(i, screw, at);
    }
    if (!this.isPlatter) frames.table.at(-1).add(this.plate(new Vector3(...scene.frame.origin)));
    this.floor = Math.min(this.floor, at.z - 0.2 * this.size);
    const base = [3.4 * this.size, 3.4 * this.size, 0.2 * this.size];
    this.root.add(this.solids.box(new Vector3(at.x, at.y, this.floor), base, "body"));
    return undefined;
  }

  plate(top) {
    const { solids, size } = this;
    return solids.box(top.clone().addScaledVector(kUp, -0.07 * size), [2.4 * size, 2.4 * size, 0.14 * size], "table");
  }

  drawFixedTable(top) {
    const { scene, solids, size } = this;
    const isArm = scene.head[0]?.rotary;
    this.floor = isArm ? Math.min(-0.3 * size, top.z - 0.8 * size) : top.z - size;
    this.root.add(this.plate(top));
    const height = top.z - 0.14 * size - this.floor;
    const middle = top.clone().setZ(this.floor + height / 2);
    this.root.add(solids.box(middle, [1.7 * size, 1.7 * size, height], "body"));
  }

  drawTableRotary(i, screw, at) {
    const direction = vector(screw.direction);
    const anchor = nearestOnAxis(screw, at);
    const isUpright = Math.abs(direction.z) > 0.9;
    if (!this.isPlatter && isUpright) return this.drawPlatter(i, anchor);
    return Math.abs(direction.z) < 0.3 ? this.drawCradle(i, direction, anchor, at) : this.drawKnee(i, direction, anchor, at);
  }

  drawPlatter(i, top) {
    const { frames, solids, size } = this;
    const at = (depth) => top.clone().addScaledVector(kUp, -depth * size);
    this.isPlatter = true;
    frames.table[i].add(solids.cylinder(at(0.08), kUp, 0.98 * size, 0.16 * size, "table"));
    for (const turn of [0, Math.PI / 2]) {
      const slot = solids.box(at(0.001), [1.9 * size, 0.05 * size, 0.006 * size], "holder");
      slot.rotation.z = turn;
      frames.table[i].add(slot);
    }
    this.groupBelow(frames.table, i).add(solids.cylinder(at(0.28), kUp, 0.72 * size, 0.26 * size, "accent"));
    return at(0.42);
  }

  // Between two bearings: a trunnion.
  drawCradle(i, direction, anchor, at) {
    const { frames, solids, size } = this;
    const inner = frames.table[i];
    const below = this.groupBelow(frames.table, i);
    const side = (k, point) => point.clone().addScaledVector(direction, k * size);
    inner.add(solids.beam(side(-1.2, at), side(1.2, at), 0.3 * size, "moving"));
    for (const k of [-1.2, 1.2]) {
      const high = side(k, anchor).setZ(Math.max(anchor.z, at.z) + 0.1 * size);
      inner.add(solids.beam(side(k, at).addScaledVector(kUp, -0.15 * size), high, 0.28 * size, "moving"));
      inner.add(solids.cylinder(side(k * 1.12, anchor), direction, 0.2 * size, 0.4 * size, "accent"));
      const bearing = side(k * 1.34, anchor);
      const foot = bearing.clone().setZ(Math.min(anchor.z, at.z) - 0.95 * size);
      below.add(solids.beam(foot, bearing.clone().addScaledVector(kUp, 0.28 * size), 0.5 * size, "body"));
    }
    return anchor.clone().setZ(Math.min(anchor.z, at.z) - 0.95 * size);
  }

  drawKnee(i, direction, anchor, at) {
    const { frames, solids, size } = this;
    if (anchor.distanceTo(at) > 0.05 * size) frames.table[i].add(solids.beam(at, anchor, 0.5 * size, "moving"));
    frames.table[i].add(solids.cylinder(anchor, direction, 0.42 * size, 0.4 * size, "accent"));
    const below = this.groupBelow(frames.table, i);
    const foot = anchor.clone().setZ(at.z - 1.1 * size).addScaledVector(kBack, 0.5 * size);
    below.add(solids.beam(foot, anchor, 0.6 * size, "body"));
    return foot;
  }

  drawSlide(i, screw, at) {
    const { frames, solids, size } = this;
    const direction = vector(screw.direction);
    const [low, high] = this.travelOf(screw);
    const slab = at.clone().addScaledVector(kUp, -0.12 * size);
    frames.table[i].add(solids.box(slab, [1.9 * size, 1.9 * size, 0.22 * size], "moving"));
    const below = this.groupBelow(frames.table, i);
    const side = new Vector3().crossVectors(direction, kUp).normalize();
    if (side.lengthSq() < 0.5) side.set(1, 0, 0);
    for (const k of [-0.6, 0.6]) {
      const rail = slab.clone().addScaledVector(kUp, -0.2 * size).addScaledVector(side, k * size);
      below.add(solids.beam(rail.clone().addScaledVector(direction, low - size),
        rail.clone().addScaledVector(direction, high + size), 0.18 * size, "holder"));
    }
    return slab.addScaledVector(kUp, -0.3 * size);
  }
}
