// SPDX-License-Identifier: GPL-3.0-or-later
// Elements in one call each, and numbers for people.

/** make("p", { class: "x" }, "text", element): functions among the attributes are listeners; null is left out. */
export function make(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(key, value);
    else if (value !== null && value !== false) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

export const grouped = (n) => Math.round(n).toLocaleString("en-US");

/** Four digits that matter. */
export function rounded(x) {
  if (x === 0) return "0";
  const size = Math.abs(x);
  return size >= 1e6 || size < 1e-4 ? x.toExponential(2) : String(Number(x.toPrecision(4)));
}

/** Of a share between 0 and 1: never 0 % of what is there, nor 100 % of what is not all. */
export function percent(share) {
  if (share > 0 && share < 0.001) return "less than 0.1 %";
  if (share < 1 && share > 0.999) return "more than 99.9 %";
  return `${Number((100 * share).toFixed(1))} %`;
}

export const counted = (n, one, many) => `${grouped(n)} ${n === 1 ? one : many}`;

/** minimum_cut -> minimum cut */
export const spoken = (name) => name.replaceAll("_", " ");
