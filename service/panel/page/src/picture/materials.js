// SPDX-License-Identifier: Apache-2.0
// Small shaders of our own: where a processor draws, those of a library take a second until the first picture.
import { Color, DoubleSide, ShaderMaterial, Vector3 } from "three";

export const kMaxFrames = 32;

// Light from above and from a sun, reckoned at the corners and not at every pixel.
const bodyShader = `
uniform mat4 frames[${kMaxFrames}];
uniform vec3 sun;
uniform vec3 ground;
attribute float frame;
attribute vec3 color;
varying vec3 shade;
void main() {
  mat4 toWorld = frames[int(frame)];
  vec3 up = normalize(mat3(toWorld) * normal);
  vec3 light = 0.46 * mix(ground, vec3(1.0), 0.5 + 0.5 * up.z) + 0.52 * max(dot(up, sun), 0.0);
  shade = pow(min(color * light, 1.0), vec3(1.0 / 2.2));
  gl_Position = projectionMatrix * viewMatrix * toWorld * vec4(position, 1.0);
}`;

const edgeShader = `
uniform mat4 frames[${kMaxFrames}];
uniform vec3 tint;
attribute float frame;
varying vec3 shade;
void main() {
  shade = tint;
  gl_Position = projectionMatrix * viewMatrix * frames[int(frame)] * vec4(position, 1.0);
}`;

const plainShader = `
uniform vec3 tint;
varying vec3 shade;
void main() {
  shade = tint;
#ifdef USE_COLOR
  shade = pow(color, vec3(1.0 / 2.2));
#endif
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const fragmentShader = `
uniform float opacity;
varying vec3 shade;
void main() { gl_FragColor = vec4(shade, opacity); }`;

const shownTint = (colour) => new Vector3(...new Color(colour).convertLinearToSRGB().toArray());

function material(vertexShader, uniforms, opacity, rest = {}) {
  return new ShaderMaterial({ vertexShader, fragmentShader, transparent: opacity < 1,
    uniforms: { ...uniforms, opacity: { value: opacity } }, ...rest });
}

// Faces whose corners carry `color` and the number of their frame.
export const bodyMaterial = (frames) => material(bodyShader,
  { frames, sun: { value: new Vector3(0.5, -1, 1.4).normalize() }, ground: { value: new Color(0x445060) } }, 1);

export const edgeMaterial = (frames, colour) => material(edgeShader, { frames, tint: { value: shownTint(colour) } }, 0.55);

// Lines whose points carry their colours.
export const lineMaterial = (opacity = 1) => material(plainShader, { tint: { value: new Vector3() } }, opacity, { vertexColors: true });

// One colour, without light.
export const plainMaterial = (colour, opacity = 1) => material(plainShader, { tint: { value: shownTint(colour) } }, opacity,
  opacity < 1 ? { side: DoubleSide, forceSinglePass: true, depthWrite: false } : {});
