// SPDX-License-Identifier: Apache-2.0
// Bodies of the machine file, as the panel's process has them.
import { STLLoader } from "three/addons/loaders/STLLoader.js";

// The geometry of a mesh by its number; nothing where it is not there or no STL file.
export async function loadMesh(number) {
  try {
    const answer = await fetch(`/mesh?number=${number}`);
    return answer.ok ? new STLLoader().parse(await answer.arrayBuffer()) : null;
  } catch {
    return null;
  }
}
