// SPDX-License-Identifier: GPL-3.0-or-later
// What the program put into the page.

const textOf = (id) => document.getElementById(id)?.textContent ?? "";

export const report = JSON.parse(textOf("report"));
export const scene = JSON.parse(textOf("scene"));
export const reportText = textOf("report");

function bytesOf(id) {
  const text = atob(textOf(id));
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** Is there anything in a buffer? */
export const has = (id) => (scene.buffers[id]?.count ?? 0) > 0;

/** Places as x, y, z one after another, relative to `origin`, from which 32 bits are enough. Without steps the buffer
 * holds 32-bit numbers. */
export function places(id, origin) {
  const { count, low, step } = scene.buffers[id];
  const buffer = bytesOf(id).buffer;
  const numbers = step === null ? new Float32Array(buffer) : new Uint16Array(buffer);
  const xyz = new Float32Array(3 * count);
  for (let i = 0; i < xyz.length; ++i)
    xyz[i] = low[i % 3] - origin[i % 3] + (step === null ? 1 : step[i % 3]) * numbers[i];
  return xyz;
}

/** Middle and size of the box of a buffer's places. */
export function boxOf(id) {
  const { low, step } = scene.buffers[id];
  const size = step.map((s) => 65535 * s);
  return { low, size, middle: low.map((l, k) => l + size[k] / 2) };
}

export const indices = (id) => new Uint32Array(bytesOf(id).buffer);
export const bytes = bytesOf;

/** A picture's address, or nothing. */
export function picture(name) {
  const text = textOf(`picture.${name}`);
  return text ? `data:image/png;base64,${text}` : null;
}
