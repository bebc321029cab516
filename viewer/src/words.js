// SPDX-License-Identifier: GPL-3.0-or-later
// The run in sentences, for readers who never saw the program.
import { has, report, scene } from "./data.js";
import { counted, grouped, percent, rounded } from "./elements.js";

const mesh = report.mesh;
const input = report.input;
const knowsInvented = has("mesh.invented");
const share = report.unsupported_area;
const knowsOutliers = scene.histograms.confidence !== null;

export function title() {
  const names = input.files.map((file) => file.path.split("/").pop());
  return names.length > 3 ? `${names[0]} and ${names.length - 1} more` : names.join(", ");
}

export function measured() {
  const files = counted(input.files.length, "file", "files");
  const lines = [
    `${counted(input.points, "point was", "points were")} read from ${files}; they are typically ` +
      `${rounded(input.spacing)} apart, in the unit of the input.`,
  ];
  if (knowsOutliers)
    lines.push(
      `${grouped(scene.points.all)} of them lie on the surface that was found, or as near to it as spacing and ` +
        "noise explain.",
    );
  if (knowsInvented && !report.options.trim)
    lines.push(`${percent(1 - share)} of the surface's area is borne out by points right there.`);
  const other = report.simplified;
  if (other)
    lines.push(
      `The mesh was then made of ${grouped(other.after.triangles)} triangles instead of ` +
        `${grouped(other.before.triangles)}, which moved the surface by ` +
        `${rounded(other.error.from_full.mean)} on average and ${rounded(other.error.from_full.max)} at most.`,
    );
  if (report.moved === null && !other && knowsInvented)
    lines.push(
      "Every corner of the mesh is one of the measured points, digit for digit" +
        (report.base ? ", but for those of the base." : "."),
    );
  const strays = report.moved?.strays ?? 0;
  if (strays > 0)
    lines.push(
      `${counted(strays, "stray point holds", "stray points hold")} the surface where others are missing: evened ` +
        `out, ${strays === 1 ? "it is" : "they are"} not where ${strays === 1 ? "it was" : "they were"} measured.`,
    );
  if (report.moved !== null && (report.moved.vertices > 0 || strays === 0))
    lines.push(
      `${counted(report.moved.vertices, "corner", "corners")} of the mesh moved from the measured points ` +
        `${report.options.smooth > 0 ? "by smoothing" : "to the middle of their noise"}, half of them by less than ` +
        `${rounded(report.moved.median)}, 99 % by less than ${rounded(report.moved.q99)}.`,
    );
  return lines;
}

export function invented() {
  const lines = [];
  if (!knowsInvented) lines.push("This method does not say which part of the surface was invented.");
  else if (share === 0) lines.push("Nothing: there are points everywhere on the surface.");
  else if (report.options.trim)
    lines.push(
      `${percent(share)} of the surface that was found had been bridged without data. As --trim asks, that part ` +
        `was cut away: the mesh is open there.`,
    );
  else
    lines.push(
      `${percent(share)} of the surface's area was bridged without data: there are no points there, and the ` +
        `surface is a guess that closes the gap.`,
      "It is orange in the view and in the pictures. Do not take measures there.",
    );
  if (report.base)
    lines.push(
      `The flat base (${counted(report.base.vertices, "corner", "corners")}) was added because --base asks for ` +
        `it; it was not measured.`,
    );
  return lines;
}

export function thrownAway() {
  const lines = [];
  const pieces = report.dropped_components;
  if (scene.outliers.all > 0)
    lines.push(
      `${counted(scene.outliers.all, "point", "points")} (${percent(scene.outliers.all / input.points)}) are ` +
        `outliers: farther from the surface than spacing and noise explain. The mesh ignores them; tick "Outliers" ` +
        "under Show to see where they are.",
    );
  if (input.duplicates > 0)
    lines.push(`${counted(input.duplicates, "point repeats", "points repeat")} the place of another one.`);
  if (input.nonfinite > 0) lines.push(`${counted(input.nonfinite, "row has", "rows have")} no finite coordinates.`);
  if (pieces.length > 0) {
    const corners = pieces.reduce((sum, piece) => sum + piece.vertices, 0);
    lines.push(
      `${counted(pieces.length, "piece", "pieces")} of surface with ${counted(corners, "corner", "corners")} in ` +
        `all ${pieces.length === 1 ? "was" : "were"} left out as specks or parts that the points do not bear out.`,
    );
  }
  if (report.options.trim) lines.push("What --trim cut away is listed under Invented.");
  if (!knowsOutliers) lines.push("This method does not say which points are outliers.");
  return lines.length > 0 ? lines : ["Nothing: every point is part of the result or right beside it."];
}

/** Rows of [question, answer, is that well?, what it means]. */
export function checks() {
  const closed = mesh.boundary_edges === 0;
  const manifold = mesh.nonmanifold_edges === 0 && mesh.nonmanifold_vertices === 0;
  const crossings = mesh.self_intersections;
  const open = report.options.trim || report.scene === "facade";
  return [
    [
      "Closed",
      closed
        ? "yes"
        : `no: ${counted(mesh.boundary_edges, "edge", "edges")} at ${counted(mesh.boundary_loops, "rim", "rims")}`,
      closed || open,
      "No holes: the mesh bounds a volume.",
    ],
    [
      "Manifold",
      manifold
        ? "yes"
        : `no: ${counted(mesh.nonmanifold_edges, "edge", "edges")}, ` +
          `${counted(mesh.nonmanifold_vertices, "vertex", "vertices")}`,
      manifold || !report.options.manifold,
      "Every edge belongs to two triangles, every corner to one fan: other programs can work with it.",
    ],
    [
      "Oriented",
      mesh.inconsistent_edges === 0 ? "yes" : `no: ${counted(mesh.inconsistent_edges, "edge", "edges")}`,
      mesh.inconsistent_edges === 0,
      "All triangles agree which side is outside.",
    ],
    [
      "Crossings",
      crossings === null
        ? "not counted"
        : `${mesh.all_self_intersections === false ? "at least " : ""}${counted(crossings, "pair", "pairs")}`,
      crossings === null || crossings === 0,
      "Pairs of triangles that pass through each other.",
    ],
    [
      "Triangles without area",
      grouped(mesh.degenerate_triangles),
      mesh.degenerate_triangles === 0,
      "Three corners on one line.",
    ],
    ["Pieces", grouped(mesh.components), true, "Parts that are not joined."],
    ["Genus", grouped(mesh.genus), true, "Number of handles, such as that of a cup; holes that go right through."],
    [
      "Size",
      `${counted(mesh.vertices, "vertex", "vertices")}, ${counted(mesh.triangles, "triangle", "triangles")}`,
      true,
      "Of the mesh that was written.",
    ],
    ["Area", rounded(mesh.area), true, "In the square of the input's unit."],
    [
      "Volume",
      mesh.volume === null ? "none" : rounded(Math.abs(mesh.volume)),
      true,
      mesh.volume === null
        ? "An open surface has none."
        : report.scene === "interior"
          ? "Free space of the rooms."
          : "In the cube of the input's unit.",
    ],
  ];
}

/** [what happened, what to do about it]: a warning says the second behind a semicolon. */
export function warnings() {
  const all = report.broken_guarantees.map((text) => [
    `The mesh is not ${text}, which it should be.`,
    "This is a fault of the program: please report it, with this page.",
  ]);
  for (const text of report.warnings) {
    const at = text.indexOf("; ");
    const sentence = (words) => words.charAt(0).toUpperCase() + words.slice(1) + (/[.?]$/.test(words) ? "" : ".");
    all.push(
      at < 0
        ? [sentence(text), "Nothing needs to be done; look whether this is what you meant."]
        : [sentence(text.slice(0, at)), sentence(text.slice(at + 2))],
    );
  }
  return all;
}
