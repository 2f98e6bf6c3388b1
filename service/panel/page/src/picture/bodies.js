// SPDX-License-Identifier: Apache-2.0
// All bodies of a machine in two things, faces and edges: a picture costs by the number of things in it. Each corner knows the
// frame that it moves with, and the frames lie in the shaders.
import { BufferAttribute, LineSegments, Mesh } from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import { bodyMaterial, edgeMaterial, kMaxFrames } from "./materials.js";

const flat = (geometry) => (geometry.index ? geometry.toNonIndexed() : geometry.clone());

function framed(geometry, matrix, frame) {
  const own = flat(geometry).applyMatrix4(matrix);
  own.setAttribute("frame", new BufferAttribute(new Uint8Array(own.attributes.position.count).fill(frame), 1));
  return own;
}

export class Bodies {
  constructor(edge) {
    this.frames = { value: [] };
    this.faces = new Mesh(undefined, bodyMaterial(this.frames));
    this.edges = new LineSegments(undefined, edgeMaterial(this.frames, edge));
    for (const one of [this.faces, this.edges]) one.frustumCulled = false;
  }

  // Again, of all parts (see Solids) that hang below `root`.
  rebuild(root) {
    const frames = [], faces = [], edges = [];
    root.traverse((part) => {
      if (!part.userData.faces) return;
      part.updateMatrix();
      // What moves by itself is its own frame; the others move with their parents.
      const isLoose = part.userData.isLoose;
      const carrier = isLoose ? part : part.parent;
      if (!frames.includes(carrier)) frames.push(carrier);
      const matrix = isLoose ? part.matrix.clone().identity() : part.matrix, frame = frames.indexOf(carrier);
      faces.push(framed(part.userData.faces, matrix, frame));
      if (part.userData.edges) edges.push(framed(part.userData.edges, matrix, frame));
    });
    if (frames.length > kMaxFrames) throw new Error(`a machine with ${frames.length} frames is not drawn`);
    const spare = frames[0]?.matrixWorld;
    this.frames.value = Array.from({ length: kMaxFrames }, (_, i) => frames[i]?.matrixWorld ?? spare);
    for (const [one, geometries] of [[this.faces, faces], [this.edges, edges]]) {
      one.geometry.dispose();
      one.geometry = mergeGeometries(geometries);
    }
  }

  show(isShown) {
    this.faces.visible = this.edges.visible = isShown;
  }
}
