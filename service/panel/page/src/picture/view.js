// SPDX-License-Identifier: Apache-2.0
// The picture: camera, floor, and whatever machine, path and trail hang in it. Draws only when something changed.
import {
  Box3, GridHelper, Mesh, PerspectiveCamera, Raycaster, Scene,
  SphereGeometry, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { coneOf } from "./cone.js";
import { Machine } from "./machine.js";
import { lineMaterial, plainMaterial } from "./materials.js";
import { loadMesh } from "./mesh.js";
import { pixelOf } from "./pixel.js";
import { Resolution } from "./resolution.js";
import { palette } from "./shapes.js";
import { isDrawnByProcessor, SmoothEdges } from "./smooth_edges.js";
import { Trail } from "./trail.js";
import { warmUp } from "./warm_up.js";

const kViews = {
  iso: [0.85, -1.25, 0.75], front: [0, -1, 0.0001], right: [1, 0, 0.0001], top: [0, -0.0001, 1],
  part: [0.85, -1.25, 0.75],
};

// While the camera turns, so many pixels are seen as one, where a graphics card draws and where a processor does.
const kSeenTurning = 2, kSeenTurningSlowly = 4;

// Whether there is WebGL for that canvas.
export const canDraw = (canvas) => canvas.getContext("webgl2", { alpha: true, antialias: false }) !== null;

export class View {
  constructor(canvas, onPick) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: false, alpha: true });
    this.isSlow = isDrawnByProcessor(this.renderer);
    this.smoothEdges = new SmoothEdges(this.renderer);
    this.resolution = new Resolution(this.renderer, this.isSlow, () => this.ask());
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(32, 1, 1, 50000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => {
      if (!this.isFollowing) this.resolution.turn();
      this.ask();
    });
    this.trail = new Trail();
    this.theme = "dark";
    this.follows = false;
    this.shown = { machine: true, path: true, trail: true, fan: false };
    this.frames = 0;
    this.onPick = onPick;
    this.watchPicks();
    warmUp(this.renderer, this.camera);
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  // ---- what is shown

  // `description`: null where it is not known; then nothing is shown.
  setMachine(description) {
    this.description = description;
    this.machine?.root.removeFromParent();
    this.floor?.removeFromParent();
    this.machine = this.floor = this.joints = this.seen = null;
    this.ask();
    if (!description) return;
    this.machine = new Machine(description, this.theme);
    this.scene.add(this.machine.root);
    this.machine.frames.workpiece.add(this.trail.root);
    if (this.path) this.machine.frames.workpiece.add(this.path.root);
    this.drawFloor();
    this.drawMarks();
    this.apply();
    this.loadMeshes();
    if (!this.isPlaced) this.look("iso");
    this.isPlaced = true;
  }

  // Bodies come after the machine, from files that the panel has; one that does not come leaves what is drawn.
  async loadMeshes() {
    const { machine } = this;
    for (const [number, { link }] of (this.description.meshes ?? []).entries()) {
      const geometry = await loadMesh(number);
      if (machine !== this.machine) return;
      if (!geometry) continue;
      machine.addMesh(link, geometry);
      this.apply();
      this.ask();
    }
  }

  setPath(path) {
    this.path?.dispose();
    this.path = path;
    if (path) this.machine?.frames.workpiece.add(path.root);
    this.apply();
    this.ask();
  }

  setTheme(theme) {
    this.theme = theme;
    this.trail.setTheme(theme);
    if (this.description) {
      const joints = this.joints;
      this.setMachine(this.description);
      if (joints) this.setJoints(joints);
    }
    this.ask();
  }

  drawFloor() {
    const size = this.machine.size;
    const colours = palette[this.theme];
    this.floor = new GridHelper(12 * size, 24, colours.floorMajor, colours.floor);
    this.floor.material.dispose();
    this.floor.material = lineMaterial();
    this.floor.rotation.x = Math.PI / 2;
    this.floor.position.z = this.machine.floor - 0.12 * size;
    this.scene.add(this.floor);
  }

  // The tip, and the cone about the singular direction of the tool axis.
  drawMarks() {
    const { machine } = this;
    const dot = new Mesh(new SphereGeometry(0.022 * machine.size, 20, 14), plainMaterial(0xff5a36));
    machine.frames.tip.add(dot);
    this.cone = coneOf(machine);
  }

  setJoints(joints, toolLength) {
    const seen = JSON.stringify([joints, toolLength, this.theme, this.follows]);
    if (!this.machine || (this.drawn === this.machine && this.seen === seen)) return;
    this.drawn = this.machine;
    this.seen = seen;
    this.joints = joints;
    if (toolLength !== undefined) this.machine.setTool(toolLength);
    this.machine.setJoints(joints);
    this.cone?.follow();
    if (this.follows) this.followTip();
    this.ask();
  }

  setAtPole(isAtPole) {
    this.cone?.setAtPole(isAtPole);
  }

  show(what, isShown) {
    this.shown[what] = isShown;
    this.apply();
    this.ask();
  }

  apply() {
    this.trail.root.visible = this.shown.trail;
    this.trail.fan.visible = this.shown.fan;
    if (this.path) {
      this.path.root.visible = this.shown.path;
      this.path.fan.visible = this.shown.fan;
    }
    if (!this.machine) return;
    this.machine.bodies.show(this.shown.machine);
  }

  // ---- the camera

  box(name) {
    const box = new Box3();
    if (name === "part" && this.path) {
      box.copy(this.path.bounds).applyMatrix4(this.machine.frames.workpiece.matrixWorld);
      const kAround = 0.06, kMin_mm = 1;
      return box.expandByScalar(Math.max(kAround * box.getSize(new Vector3()).length(), kMin_mm));
    }
    const { machine } = this;
    const centre = new Vector3().setFromMatrixPosition(machine.frames.workpiece.matrixWorld);
    const tip = machine.frames.tipInScene();
    const around = 2.6 * machine.size;
    for (const point of [centre, tip]) box.expandByPoint(point);
    box.expandByVector(new Vector3(around, around, around));
    return box;
  }

  look(name) {
    if (!this.machine) return;
    const box = this.box(name);
    const centre = box.getCenter(new Vector3());
    const radius = box.getSize(new Vector3()).length() / 2;
    const aspect = Math.min(1, this.camera.aspect);
    const distance = (0.98 * radius) / Math.sin((this.camera.fov * Math.PI) / 360) / aspect;
    const direction = new Vector3(...kViews[name]).normalize();
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(direction, distance);
    this.camera.near = distance / 200;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.ask();
  }

  follow(isFollowing) {
    this.follows = isFollowing;
    if (isFollowing) this.followTip();
  }

  followTip() {
    if (!this.machine) return;
    const tip = this.machine.frames.tipInScene();
    this.camera.position.add(tip.clone().sub(this.controls.target));
    this.controls.target.copy(tip);
    this.isFollowing = true;
    this.controls.update();
    this.isFollowing = false;
  }

  // Where on the canvas the tip is, in pixels of the page.
  tipPixel() {
    const { clientWidth, clientHeight } = this.canvas;
    return pixelOf(this.machine.frames.tipInScene(), this.camera, clientWidth, clientHeight);
  }

  // ---- drawing and clicks

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.ask();
  }

  ask() {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame((now_ms) => {
      this.isAsked = false;
      this.resolution.picture(now_ms);
      this.draw();
    });
  }

  draw() {
    const { isTurning } = this.resolution, turning = this.isSlow ? kSeenTurningSlowly : kSeenTurning;
    const seen = isTurning ? turning : 1;
    const pixel = (seen * this.camera.fov * Math.PI) / 180 / this.canvas.height;
    this.camera.updateMatrixWorld();
    for (const line of this.lines()) line.setDetail(this.camera, pixel);
    this.frames += 1;
    if (this.isSlow && isTurning) this.renderer.render(this.scene, this.camera);
    else this.smoothEdges.draw(this.scene, this.camera);
  }

  // The long lines that are shown.
  lines() {
    return [this.shown.path && this.path?.line, this.shown.trail && this.trail.line].filter(Boolean);
  }

  watchPicks() {
    let from = null;
    this.canvas.addEventListener("pointerdown", (event) => (from = [event.clientX, event.clientY]));
    this.canvas.addEventListener("pointerup", (event) => {
      const isClick = from && Math.hypot(event.clientX - from[0], event.clientY - from[1]) < 4;
      if (isClick && this.machine) this.pick(event);
    });
  }

  pick(event) {
    const area = this.canvas.getBoundingClientRect();
    const at = new Vector2(((event.clientX - area.left) / area.width) * 2 - 1, 1 - ((event.clientY - area.top) / area.height) * 2);
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    ray.params.Line.threshold = 0.012 * this.camera.position.distanceTo(this.controls.target);
    const hits = this.lines().map((line) => ({ line, hit: line.pick(ray) })).filter(({ hit }) => hit);
    const nearest = hits.sort((a, b) => a.hit.distance - b.hit.distance)[0];
    this.onPick?.(nearest ? { isPath: nearest.line === this.path?.line, index: nearest.hit.index } : null);
  }
}
