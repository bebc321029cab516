// SPDX-License-Identifier: GPL-3.0-or-later
// Switches of the view, by mouse and by key.
import { bytes, has, report, scene } from "./data.js";
import { grouped, make, percent, rounded } from "./elements.js";

const layer = (name) => (view, on) => view.show(name, on);
const colour = (name) => (view, on) => view.paint(name, on);

/** key, id, name, on at first, what it does, is there anything, a note */
const switches = [
  ["m", "mesh", "Mesh", true, layer("mesh"), has("mesh.triangles"), () => `${grouped(scene.mesh.shown)} triangles`],
  [
    "i",
    "invented",
    "Invented area",
    true,
    colour("invented"),
    has("mesh.invented") && bytes("mesh.invented").includes(1),
    () => percent(report.options.trim ? 0 : report.unsupported_area),
  ],
  ["s", "support", "Support", false, colour("support"), has("mesh.support"), () => "red: none, blue: full"],
  ["w", "wireframe", "Edges of triangles", false, layer("wireframe"), true, () => ""],
  ["p", "points", "Points", false, layer("points"), has("points"), () => grouped(scene.points.all)],
  ["o", "outliers", "Outliers", false, layer("outliers"), has("outliers"), () => grouped(scene.outliers.all)],
  [
    "d",
    "leftOut",
    "Surface left out",
    false,
    layer("leftOut"),
    has("left_out.triangles"),
    () => `${grouped(scene.left_out.all)} triangles`,
  ],
  ["a", "insidePoles", "Poles inside", false, layer("insidePoles"), has("poles.inside"), () => ""],
  ["b", "outsidePoles", "Poles outside", false, layer("outsidePoles"), has("poles.outside"), () => ""],
];
const sides = ["front", "back", "left", "right", "top", "bottom"];

/** One sentence where the view shows less than there is. */
export function whatIsShown() {
  const less = [
    ["mesh", "triangles of the mesh"],
    ["points", "points"],
    ["outliers", "outliers"],
    ["left_out", "triangles left out"],
  ]
    .filter(([id]) => scene[id].shown < scene[id].all)
    .map(([id, what]) => `${grouped(scene[id].shown)} of ${grouped(scene[id].all)} ${what}`);
  if (less.length === 0) return null;
  const simple =
    scene.mesh.shown < scene.mesh.all
      ? " The mesh is simplified for this view alone; the file that was written has all of it."
      : "";
  return `The view shows ${less.join(", ")}.${simple}`;
}

function switchRow(view, [, id, name, on, act, there, note]) {
  const box = make("input", {
    type: "checkbox",
    id: `show-${id}`,
    checked: on && there,
    disabled: !there,
    change: (event) => act(view, event.target.checked),
  });
  return make(
    "label",
    { class: there ? "switch" : "switch nothing" },
    box,
    make("span", { class: `dot ${id}` }),
    make("span", {}, name),
    make("small", {}, there ? note() : "none"),
  );
}

function cutControls(view) {
  const shown = make("output", { for: "cut-place" });
  const show = (level) => (shown.textContent = rounded(level));
  const place = make("input", {
    type: "range",
    id: "cut-place",
    min: 0,
    max: 1,
    step: 0.005,
    value: 0.5,
    "aria-label": "Place of the cut",
    input: (event) => show(view.setCut({ place: Number(event.target.value) })),
  });
  const axis = make(
    "select",
    {
      id: "cut-axis",
      "aria-label": "Axis of the cut",
      change: (event) => show(view.setCut({ axis: Number(event.target.value) })),
    },
    ...["x", "y", "z"].map((name, k) => make("option", { value: k, selected: k === 2 }, name)),
  );
  show(view.setCut({}));
  return make(
    "fieldset",
    {},
    make("legend", {}, "Cut"),
    make(
      "label",
      { class: "row" },
      make("input", { type: "checkbox", id: "cut-on", change: (event) => view.setCut({ on: event.target.checked }) }),
      make("span", {}, "Cut the object open"),
    ),
    make("div", { class: "row" }, make("label", {}, "at ", axis, " = "), shown),
    place,
    make(
      "label",
      { class: "row" },
      make("input", {
        type: "checkbox",
        id: "cut-flip",
        change: (event) => view.setCut({ flipped: event.target.checked }),
      }),
      make("span", {}, "Keep the other side"),
    ),
  );
}

function cameraControls(view) {
  return make(
    "fieldset",
    {},
    make("legend", {}, "Look from"),
    make(
      "div",
      { class: "buttons" },
      ...sides.map((side, k) =>
        make("button", { type: "button", title: `key ${k + 1}`, click: () => view.look(side) }, side),
      ),
      make("button", { type: "button", title: "key 0", click: () => view.look("corner") }, "corner"),
    ),
    make(
      "label",
      { class: "row" },
      "Up is ",
      make(
        "select",
        { id: "up", change: (event) => view.setUp(event.target.value) },
        ...["z", "y", "x", "-z", "-y", "-x"].map((axis) => make("option", { value: axis }, axis)),
      ),
    ),
  );
}

const keyHelp = () =>
  make(
    "details",
    { class: "keys" },
    make("summary", {}, "Keys"),
    make(
      "p",
      {},
      "Click into the picture, or reach it with Tab. Arrows turn, + and - zoom, 0 goes back, 1 to 6 look from " +
        "front, back, left, right, top, bottom.",
    ),
    make(
      "p",
      {},
      switches.map(([key, , name]) => `${key.toUpperCase()} ${name.toLowerCase()}`).join(", ") +
        "; C cut, comma and full stop move it, X, Y and Z choose its axis, F flips it.",
    ),
  );

/** Changes a control as a hand would. */
function set(id, change) {
  const control = document.getElementById(id);
  if (!control || control.disabled) return;
  change(control);
  control.dispatchEvent(new Event(control.type === "range" ? "input" : "change"));
}

function keyPressed(view, event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const flip = (id) => set(id, (box) => (box.checked = !box.checked));
  const move = (by) => set("cut-place", (range) => (range.value = Number(range.value) + by));
  const step = Math.PI / 24;
  const actions = {
    ArrowLeft: () => view.turn(-step, 0),
    ArrowRight: () => view.turn(step, 0),
    ArrowUp: () => view.turn(0, -step),
    ArrowDown: () => view.turn(0, step),
    "+": () => view.zoom(1 / 1.15),
    "=": () => view.zoom(1 / 1.15),
    "-": () => view.zoom(1.15),
    0: () => view.look("corner"),
    c: () => flip("cut-on"),
    f: () => flip("cut-flip"),
    ",": () => move(-0.02),
    ".": () => move(0.02),
  };
  sides.forEach((side, k) => (actions[k + 1] = () => view.look(side)));
  ["x", "y", "z"].forEach((axis, k) => (actions[axis] = () => set("cut-axis", (select) => (select.value = k))));
  for (const [key, id] of switches) actions[key] = () => flip(`show-${id}`);
  const act = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!act) return;
  event.preventDefault();
  act();
}

export function controls(view) {
  view.canvas.addEventListener("keydown", (event) => keyPressed(view, event));
  view.canvas.setAttribute("aria-label", "The mesh. Arrows turn it, plus and minus zoom, letters switch layers.");
  return make(
    "aside",
    { class: "controls" },
    make("fieldset", {}, make("legend", {}, "Show"), ...switches.map((entry) => switchRow(view, entry))),
    cutControls(view),
    cameraControls(view),
    keyHelp(),
  );
}

export { sides as stillNames };
