// SPDX-License-Identifier: Apache-2.0
// How a picture gets onto the canvas: with smooth edges, four samples of each pixel, or plainly where a processor draws in
// the place of a graphics card and the camera turns.
import { NoBlending, ShaderMaterial, Vector2, WebGLRenderTarget } from "three";
import { FullScreenQuad } from "three/addons/postprocessing/Pass.js";

const kSamples = 4;

// The pictures of this renderer are drawn by a processor.
export function isDrawnByProcessor(renderer) {
  const gl = renderer.getContext();
  const own = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(own ? own.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

const copying = () => new ShaderMaterial({
  uniforms: { picture: { value: null } },
  vertexShader: "varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }",
  fragmentShader: "uniform sampler2D picture; varying vec2 at; void main() { gl_FragColor = texture2D(picture, at); }",
  blending: NoBlending, depthTest: false, depthWrite: false,
});

export class SmoothEdges {
  // `renderer`: without edges of its own (`antialias: false`).
  constructor(renderer) {
    this.renderer = renderer;
    this.target = new WebGLRenderTarget(1, 1, { samples: kSamples });
    this.copy = new FullScreenQuad(copying());
    this.copy.material.uniforms.picture.value = this.target.texture;
  }

  draw(scene, camera) {
    const { renderer, target } = this;
    const { x: width, y: height } = renderer.getDrawingBufferSize(new Vector2());
    target.setSize(width, height);
    renderer.setRenderTarget(target);
    renderer.render(scene, camera);
    renderer.setRenderTarget(null);
    this.copy.render(renderer);
  }
}
