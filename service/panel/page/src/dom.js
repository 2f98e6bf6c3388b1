// SPDX-License-Identifier: Apache-2.0
// Elements by id and by hand. Text goes in as text, never as HTML.
export const byId = (id) => document.getElementById(id);

export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name === "class") made.className = value;
    else if (name.startsWith("aria-") || name === "role") made.setAttribute(name, value);
    else made[name] = value;
  }
  made.append(...children);
  return made;
}

// Writes only what changed: a page that stands still costs nothing.
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

// How full a bar is, 0 to 1, to a tenth of a percent.
export function setShare(bar, share) {
  const text = `scaleX(${share.toFixed(3)})`;
  if (bar.style.transform !== text) bar.style.transform = text;
}
