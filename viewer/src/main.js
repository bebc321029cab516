// SPDX-License-Identifier: GPL-3.0-or-later
import { histogram, sortedValues, stages } from "./charts.js";
import { controls, stillNames, whatIsShown } from "./controls.js";
import { has, picture, report, reportText, scene } from "./data.js";
import { grouped, make, percent, rounded, spoken } from "./elements.js";
import { View } from "./view.js";
import { checks, invented, measured, thrownAway, title, warnings } from "./words.js";

const page = document.getElementById("page");

const card = (name, heading, figure, lines) =>
  make(
    "section",
    { class: `card ${name}` },
    make("h2", {}, heading),
    make("p", { class: "figure" }, figure),
    ...lines.map((line) => make("p", {}, line)),
  );

function cards() {
  const known = has("mesh.invented");
  const share = report.unsupported_area;
  return make(
    "div",
    { class: "cards" },
    card("measured", "Measured", grouped(report.input.points) + " points", measured()),
    card("invented", "Invented", known ? percent(share) + " of the area" : "not known", invented()),
    card("thrown", "Thrown away", grouped(scene.outliers.all + report.input.nonfinite) + " points", thrownAway()),
  );
}

function warningList() {
  const all = warnings();
  if (all.length === 0)
    return make(
      "section",
      { class: "calm" },
      make("p", {}, "No warnings: nothing in this run asks for a second look."),
    );
  return make(
    "section",
    { class: "warnings" },
    make("h2", {}, all.length === 1 ? "One warning" : `${all.length} warnings`),
    make(
      "ul",
      {},
      ...all.map(([what, remedy]) =>
        make("li", {}, make("p", {}, what), make("p", { class: "remedy" }, make("b", {}, "What to do: "), remedy)),
      ),
    ),
  );
}

function checkTable() {
  return make(
    "section",
    {},
    make("h2", {}, "Is the mesh sound?"),
    make(
      "table",
      { class: "checks" },
      make(
        "tbody",
        {},
        ...checks().map(([name, answer, well, meaning]) =>
          make(
            "tr",
            { class: well ? "" : "bad" },
            make("th", { scope: "row" }, name),
            make("td", {}, answer),
            make("td", { class: "meaning" }, meaning),
          ),
        ),
      ),
    ),
  );
}

function viewSection() {
  const holder = make("div", { class: "view" });
  const section = make("section", { class: "stage" }, make("h2", {}, "Look at it"), holder);
  let view = null;
  const start = () => {
    const less = whatIsShown();
    try {
      view = new View(holder);
    } catch (error) {
      holder.replaceChildren(
        make(
          "p",
          { class: "no-view" },
          `This browser cannot draw in three dimensions (${error.message}). The still pictures below need nothing.`,
        ),
      );
      return null;
    }
    section.append(controls(view));
    if (less) section.append(make("p", { class: "note less" }, less));
    section.append(
      make(
        "p",
        { class: "note" },
        "Drag to turn, right button or two fingers to move, wheel to zoom. The inside of the surface is dark " +
          "red. Coordinates are those of the input.",
      ),
    );
    const dark = window.matchMedia("(prefers-color-scheme: dark)");
    const follow = () => view.background(dark.matches ? 0x16191e : 0xf6f5f2);
    dark.addEventListener("change", follow);
    follow();
    return view;
  };
  return [section, start];
}

function chartSection() {
  const { poles, tetrahedra } = scene.values;
  const { support, noise, confidence } = scene.histograms;
  const all = [];
  if (poles)
    all.push(
      sortedValues(
        poles,
        "First vector: the poles",
        "A pole is the centre of a large empty ball beside a point. Each has a component in the eigenvector; " +
          "below 0 it is inside the object, above outside. A steep step through 0 means that the two sides are " +
          "easy to tell apart, a gentle slope that there is doubt.",
      ),
    );
  if (tetrahedra)
    all.push(
      sortedValues(
        tetrahedra,
        "Second stage: all tetrahedra",
        "The space between the points is filled with tetrahedra; the surface runs between those below 0 " +
          "(inside) and those above (outside). The size says how sure that is.",
      ),
    );
  if (support)
    all.push(
      histogram(
        support,
        "Support of the surface",
        "0: nothing bears it out; 1: points all around",
        "Share of the area by how well the points bear it out. What is below 1/4 counts as invented.",
        (v) => v < 0.25,
      ),
    );
  if (noise)
    all.push(
      histogram(
        noise,
        "Noise of the points",
        "standard deviation across the surface, in spacings",
        "How far points scatter about the surface, beside how far they are from one another. Above 1 details are lost.",
      ),
    );
  if (confidence)
    all.push(
      histogram(
        confidence,
        "Points or outliers",
        "confidence that a point lies on the surface",
        "Below 1/2 a point is an outlier.",
        (v) => v < 0.5,
      ),
    );
  return all.length === 0
    ? null
    : make("section", {}, make("h2", {}, "How sure it is"), make("div", { class: "charts" }, ...all));
}

function stills() {
  const all = stillNames.map((name) => [name, picture(name)]).filter(([, address]) => address);
  if (all.length === 0) return null;
  const looks = {
    front: "along +y",
    back: "along -y",
    left: "along +x",
    right: "along -x",
    top: "along -z",
    bottom: "along +z",
  };
  return make(
    "section",
    { class: "stills" },
    make("h2", {}, "Six sides"),
    make(
      "p",
      {},
      "Of the whole mesh, z upward, all at one scale. Orange was invented; red is the inside of the surface, " +
        "seen where it is open.",
    ),
    make(
      "div",
      { class: "grid" },
      ...all.map(([name, address]) =>
        make(
          "figure",
          {},
          make("img", { src: address, alt: `The mesh from ${name}` }),
          make("figcaption", {}, `${name} (looking ${looks[name]})`),
        ),
      ),
    ),
  );
}

const shown = (value) => (value !== null && typeof value === "object" ? JSON.stringify(value) : String(value));

function table(rows, names) {
  return make(
    "table",
    {},
    names ? make("thead", {}, make("tr", {}, ...names.map((name) => make("th", { scope: "col" }, name)))) : null,
    make(
      "tbody",
      {},
      ...rows.map(([first, ...rest]) =>
        make("tr", {}, make("th", { scope: "row" }, first), ...rest.map((cell) => make("td", {}, cell))),
      ),
    ),
  );
}

const fold = (name, ...content) => make("details", {}, make("summary", {}, name), ...content);

function details() {
  const address = "data:application/json;charset=utf-8," + encodeURIComponent(reportText + "\n");
  const solved = report.partitions.map((p) => [
    spoken(p.stage),
    grouped(p.nodes),
    grouped(p.edges),
    rounded(p.eigenvalue),
    rounded(p.residual),
    shown(p.iterations),
    spoken(p.status),
  ]);
  const pieces = report.dropped_components
    .slice(0, 50)
    .map((p, i) => [
      String(i + 1),
      grouped(p.vertices),
      grouped(p.triangles),
      p.support.toFixed(2),
      p.centre.map((c) => Number(c.toPrecision(7))).join(", "),
    ]);
  return make(
    "section",
    {},
    make("h2", {}, "How it was made"),
    table(
      report.input.files.map((file) => [file.path, grouped(file.points), make("code", {}, file.sha256)]),
      ["input", "points", "SHA-256"],
    ),
    make("p", {}, "Command: ", make("code", {}, report.command.join(" "))),
    fold(
      `Stages: ${report.seconds.toFixed(2)} s in all, ${grouped(report.peak_memory_bytes / 1e6)} MB at most`,
      stages(report.stages),
    ),
    fold("Every option", table(Object.entries(report.options).map(([name, value]) => [spoken(name), shown(value)]))),
    solved.length > 0
      ? fold("Solutions", table(solved, ["graph", "nodes", "edges", "eigenvalue", "residual", "steps", "status"]))
      : null,
    pieces.length > 0
      ? fold("Pieces left out", table(pieces, ["", "vertices", "triangles", "support", "centre"]))
      : null,
    make("div", { class: "raw" }, fold("The whole report", make("pre", {}, JSON.stringify(report, null, 2)))),
    make(
      "p",
      {},
      make("a", { href: address, download: "report.json" }, "Save the report as JSON"),
      `; eigencrust rerun report.json does the run again, with version ${report.version} to the same bytes.`,
    ),
  );
}

const [stage, start] = viewSection();
document.title = `${title()} – Eigencrust`;
page.append(
  make(
    "header",
    {},
    make("h1", {}, title()),
    make(
      "p",
      {},
      `A surface made from measured points by Eigencrust ${report.version}. This page says what of it was ` +
        `measured, what was invented to close it, and what was thrown away.`,
    ),
  ),
  cards(),
  warningList(),
  stage,
  checkTable(),
  ...[chartSection(), stills(), details()].filter((part) => part),
);
window.addEventListener("beforeprint", () =>
  document.querySelectorAll("details").forEach((part) => (part.open = true)),
);
// Words first, then the picture.
requestAnimationFrame(() =>
  setTimeout(() => {
    const view = start();
    view?.drawNow();
    document.documentElement.dataset.ready = view ? "view" : "words";
  }),
);
