// SPDX-License-Identifier: Apache-2.0
// The only conversions of the page: inside mm, rad, s; shown mm, degrees.
export const degrees = (radians) => (radians * 180) / Math.PI;
export const shown = (joint, value) => (joint.rotary ? degrees(value) : value);
export const unit = (joint) => (joint.rotary ? "°" : "mm");
// A minus as wide as a digit, so that columns stand still.
export const fixed = (value, digits) => {
  const text = (Math.abs(value) < 0.5 * 10 ** -digits ? 0 : value).toFixed(digits);
  return text.replace("-", "\u2212");
};
export const clock = (seconds) => {
  if (!Number.isFinite(seconds)) return "\u221e";
  const whole = Math.max(0, Math.round(seconds));
  const two = (value) => String(value).padStart(2, "0");
  return whole >= 3600
    ? `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`
    : `${Math.floor(whole / 60)}:${two(whole % 60)}`;
};
