// SPDX-License-Identifier: Apache-2.0
// Bodies that machines are drawn with: plain solids with their edges.
import {
  BoxGeometry, BufferAttribute, Color, ConeGeometry, CylinderGeometry, EdgesGeometry, LineSegments,
  Mesh, Object3D, Vector3,
} from "three";
import { bytesOf } from "./colour.js";
import { plainMaterial } from "./materials.js";

export const palette = {
  dark: { body: 0x5b6675, moving: 0x7f8da0, accent: 0x3aa0ff, table: 0x6d7886, tool: 0xd9dee6, holder: 0x9aa4b2,
          edge: 0x11161d, floor: 0x2a3340, floorMajor: 0x3a4657 },
  light: { body: 0xb9c2cd, moving: 0xd3dae2, accent: 0x1f7ae0, table: 0xc4ccd6, tool: 0x59636f, holder: 0x8f99a6,
           edge: 0x5d6772, floor: 0xd5dbe2, floorMajor: 0xb8c1cc },
};

export class Solids {
  constructor(theme) {
    const colours = palette[theme];
    this.colours = colours;
    this.bound = plainMaterial(colours.accent, 0.7);
  }

  // A part: its faces and edges, which `Bodies` draws. Nothing of it is drawn by itself.
  solid(geometry, role) {
    const part = this.mesh(geometry, role);
    part.userData.edges = new EdgesGeometry(geometry, 28);
    return part;
  }

  // A part without edges: those of a file may be many.
  mesh(geometry, role) {
    const { count } = geometry.attributes.position;
    const tint = bytesOf(new Color(this.colours[role]));
    const colours = new Uint8Array(3 * count);
    for (let i = 0; i < count; ++i) colours.set(tint, 3 * i);
    geometry.setAttribute("color", new BufferAttribute(colours, 3, true));
    geometry.deleteAttribute("uv");
    const part = new Object3D();
    part.userData.faces = geometry;
    return part;
  }

  // A box with its sides along x, y, z of M.
  box(centre, size, role) {
    const body = this.solid(new BoxGeometry(...size), role);
    body.position.copy(centre);
    return body;
  }

  // The edges alone of a box from `min` to `max`.
  frame(min, max) {
    const size = max.map((end, i) => end - min[i]);
    const edges = new LineSegments(new EdgesGeometry(new BoxGeometry(...size)), this.bound);
    edges.position.set(...min.map((end, i) => end + size[i] / 2));
    return edges;
  }

  // A cylinder about `centre` along `direction`.
  cylinder(centre, direction, radius, length, role, radiusEnd = radius) {
    const body = this.solid(new CylinderGeometry(radiusEnd, radius, length, 40), role);
    body.position.copy(centre);
    body.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), direction);
    return body;
  }

  // A square beam between two points.
  beam(from, to, width, role, widthEnd = width) {
    const along = to.clone().sub(from);
    const length = along.length();
    const round = new CylinderGeometry(widthEnd * Math.SQRT1_2, width * Math.SQRT1_2, length, 4);
    const geometry = round.rotateY(Math.PI / 4).toNonIndexed();
    geometry.computeVertexNormals();
    const body = this.solid(geometry, role);
    body.position.copy(from).addScaledVector(along, 0.5);
    body.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), along.normalize());
    return body;
  }

  // Its tip at the origin, open towards -y.
  cone(halfAngle, length, material) {
    const geometry = new ConeGeometry(Math.tan(halfAngle) * length, length, 48, 1, true);
    return new Mesh(geometry.translate(0, -length / 2, 0), material);
  }
}
