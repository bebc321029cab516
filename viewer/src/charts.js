// SPDX-License-Identifier: GPL-3.0-or-later
// Charts as SVG, in the colours of the page.
import { grouped, make, rounded, spoken } from "./elements.js";

const width = 350,
  height = 190,
  left = 48,
  right = 12,
  top = 12,
  bottom = 40;

function svg(name, attributes, text) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

function frame(label) {
  const chart = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label, class: "chart" });
  chart.append(svg("line", { x1: left, y1: height - bottom, x2: width - right, y2: height - bottom, class: "axis" }));
  return chart;
}

function axisText(chart, x, y, text, anchor) {
  chart.append(svg("text", { x, y, "text-anchor": anchor, class: "tick" }, text));
}

function figure(chart, heading, caption) {
  return make("figure", {}, make("h3", {}, heading), chart, make("figcaption", {}, caption));
}

/** Bars of a histogram. `low` colours parts below a limit; values are turned into shares of all. */
export function histogram(data, heading, axis, caption, isLow = () => false) {
  const { low, high, counts } = data;
  const sum = counts.reduce((a, b) => a + b, 0) || 1;
  const most = Math.max(...counts) || 1;
  const chart = frame(`${heading}: ${caption}`);
  const step = (width - left - right) / counts.length;
  const tall = height - top - bottom;
  counts.forEach((count, i) => {
    const middle = low + ((i + 0.5) / counts.length) * (high - low);
    const size = (count / most) * tall;
    const bar = svg("rect", {
      x: left + i * step + 0.5,
      y: height - bottom - size,
      width: Math.max(step - 1, 0.5),
      height: size,
      class: isLow(middle) ? "bar low" : "bar",
    });
    bar.append(svg("title", {}, `around ${rounded(middle)}: ${((100 * count) / sum).toFixed(1)} %`));
    chart.append(bar);
  });
  axisText(chart, left, height - bottom + 16, rounded(low), "start");
  axisText(chart, width - right, height - bottom + 16, rounded(high), "end");
  axisText(chart, (left + width - right) / 2, height - 6, axis, "middle");
  axisText(chart, left - 6, top + 10, `${((100 * most) / sum).toFixed(0)} %`, "end");
  axisText(chart, left - 6, height - bottom, "0", "end");
  return figure(chart, heading, caption);
}

/** Values in increasing order, with what is below 0 in the colour of the inside. */
export function sortedValues(data, heading, caption) {
  const { values, count, inside } = data;
  const chart = frame(`${heading}: ${caption}`);
  // A few values may be far larger than all others: the square root of the size keeps both in sight.
  const bend = (v) => Math.sign(v) * Math.sqrt(Math.abs(v));
  const low = Math.min(bend(values[0]), 0),
    high = Math.max(bend(values[values.length - 1]), 0);
  const span = high - low || 1;
  const x = (i) => left + (i / Math.max(values.length - 1, 1)) * (width - left - right);
  const y = (v) => top + ((high - bend(v)) / span) * (height - top - bottom);
  const line = (part, first) => part.map((v, i) => `${x(first + i).toFixed(1)},${y(v).toFixed(1)}`).join(" ");
  const turn = values.findIndex((v) => v >= 0);
  const split = turn < 0 ? values.length : turn;
  chart.append(svg("line", { x1: left, y1: y(0), x2: width - right, y2: y(0), class: "zero" }));
  if (split > 0) chart.append(svg("polyline", { points: line(values.slice(0, split + 1), 0), class: "curve inside" }));
  if (split < values.length)
    chart.append(svg("polyline", { points: line(values.slice(split), split), class: "curve outside" }));
  axisText(chart, left - 6, top + 8, rounded(Math.max(values[values.length - 1], 0)), "end");
  axisText(chart, left - 6, height - bottom, rounded(Math.min(values[0], 0)), "end");
  axisText(chart, left - 6, y(0) + 4, "0", "end");
  axisText(chart, left, height - bottom + 16, `${grouped(inside)} inside`, "start");
  axisText(chart, width - right, height - bottom + 16, `${grouped(count - inside)} outside`, "end");
  axisText(
    chart,
    (left + width - right) / 2,
    height - 6,
    "in increasing order; height: square root of the size",
    "middle",
  );
  return figure(chart, heading, caption);
}

/** Seconds of the stages. */
export function stages(all) {
  const most = Math.max(...all.map((stage) => stage.seconds)) || 1;
  const rows = all.map((stage) => {
    const rest = Object.entries(stage).filter(
      ([key]) => !["name", "seconds", "peak_memory_bytes", "beside"].includes(key),
    );
    const bar = make("span", { class: "time-bar" });
    bar.style.width = `${(100 * stage.seconds) / most}%`;
    return make(
      "tr",
      {},
      make("th", { scope: "row" }, spoken(stage.name) + (stage.beside ? " (beside the one before)" : "")),
      make("td", { class: "number" }, `${stage.seconds.toFixed(3)} s`),
      make("td", { class: "time" }, bar),
      make("td", { class: "number" }, `${grouped(stage.peak_memory_bytes / 1e6)} MB`),
      make("td", {}, rest.map(([key, value]) => `${spoken(key)} ${rounded(value)}`).join(", ")),
    );
  });
  return make(
    "table",
    {},
    make(
      "thead",
      {},
      make(
        "tr",
        {},
        ...["stage", "time", "", "memory up to its end", "counts"].map((name) => make("th", { scope: "col" }, name)),
      ),
    ),
    make("tbody", {}, ...rows),
  );
}
