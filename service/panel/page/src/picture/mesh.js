// SPDX-License-Identifier: Apache-2.0
// Bodies of the machine file, as the panel's process has them.
import { STLLoader } from "three/addons/loaders/STLLoader.js";

// The geometry of a mesh by its number; nothing where it is not there or no STL file.
export async function loadMesh(number) {
  const kBusy = 503, kAgain_ms = 300, kTries = 20;
  try {
    let answer = await fetch(`/mesh?number=${number}`);
    for (let i = 0; answer.status === kBusy && i < kTries; ++i) {
      await new Promise((done) => setTimeout(done, kAgain_ms));
      answer = await fetch(`/mesh?number=${number}`);
    }
    return answer.ok ? new STLLoader().parse(await answer.arrayBuffer()) : null;
  } catch {
    return null;
  }
}
