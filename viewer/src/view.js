// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh and the cloud to turn, cut and take apart.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { boxOf, bytes, has, indices, places } from "./data.js";

const measuredColour = new THREE.Color(0xd9c9ae),
  inventedColour = new THREE.Color(0xeb7d23);
const badSupport = new THREE.Color(0xb03a5b),
  goodSupport = new THREE.Color(0x3f8fb5);
const backColour = new THREE.Color(0x7a4a55);

/** Places of three corners per triangle: so that each triangle can have a colour of its own. */
function corners(id, origin) {
  const xyz = places(`${id}.places`, origin),
    index = indices(`${id}.triangles`);
  const position = new Float32Array(3 * index.length);
  for (let i = 0; i < index.length; ++i) position.set(xyz.subarray(3 * index[i], 3 * index[i] + 3), 3 * i);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
  return geometry;
}

/** The side that should not be seen, but behind a cut, has a colour of its own. */
function surfaceMaterial(settings) {
  const material = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, flatShading: true, ...settings });
  material.onBeforeCompile = (shader) => {
    shader.uniforms.back = { value: backColour };
    shader.fragmentShader = shader.fragmentShader
      .replace("void main() {", "uniform vec3 back;\nvoid main() {")
      .replace("#include <color_fragment>", "#include <color_fragment>\nif (!gl_FrontFacing) diffuseColor.rgb = back;");
  };
  return material;
}

function pointCloud(id, origin, colour, size) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(places(id, origin), 3));
  return new THREE.Points(
    geometry,
    new THREE.PointsMaterial({
      color: colour,
      size: size * Math.min(window.devicePixelRatio, 2),
      sizeAttenuation: false,
    }),
  );
}

const upRotations = {
  z: [-Math.PI / 2, 0, 0],
  y: [0, 0, 0],
  x: [0, 0, Math.PI / 2],
  "-z": [Math.PI / 2, 0, 0],
  "-y": [Math.PI, 0, 0],
  "-x": [0, 0, -Math.PI / 2],
};
// From where the camera looks, with y upward.
const sides = {
  front: [0, 0, 1],
  back: [0, 0, -1],
  left: [-1, 0, 0],
  right: [1, 0, 0],
  top: [0, 1, 0.001],
  bottom: [0, -1, 0.001],
  corner: [0.55, 0.45, 0.9],
};

export class View {
  constructor(holder) {
    this.holder = holder;
    this.renderer = new THREE.WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    holder.append(this.canvas);
    const box = boxOf("mesh.places");
    this.origin = box.middle;
    this.low = box.low;
    this.size = box.size;
    this.radius = Math.hypot(...box.size) / 2 || 1;
    this.scene = new THREE.Scene();
    this.root = new THREE.Group();
    this.scene.add(this.root);
    this.camera = new THREE.PerspectiveCamera(30, 1, this.radius / 50, this.radius * 50);
    const light = new THREE.DirectionalLight(0xffffff, 2.6);
    light.position.set(-0.4, 0.7, 1);
    this.camera.add(light);
    this.scene.add(this.camera, new THREE.HemisphereLight(0xffffff, 0x707888, 0.8));
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    this.plane = new THREE.Plane();
    this.cut = { on: false, axis: 2, place: 0.5, flipped: false };
    this.colouring = { invented: true, support: false };
    this.layers = {};
    this.#addMesh();
    this.setUp("z");
    new ResizeObserver(() => this.#resize()).observe(holder);
    this.#resize();
    this.look("corner");
  }

  #addMesh() {
    this.geometry = corners("mesh", this.origin);
    const count = this.geometry.attributes.position.count;
    this.geometry.setAttribute("color", new THREE.BufferAttribute(new Uint8Array(3 * count), 3, true));
    this.marks = has("mesh.invented") ? bytes("mesh.invented") : null;
    this.support = has("mesh.support") ? bytes("mesh.support") : null;
    this.layers.mesh = new THREE.Mesh(
      this.geometry,
      surfaceMaterial({ vertexColors: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }),
    );
    this.root.add(this.layers.mesh);
    this.#paint();
  }

  /** What is not shown at first is made when it is asked for. */
  #make(name) {
    switch (name) {
      case "points":
        return pointCloud("points", this.origin, 0x2f6fb0, 1.8);
      case "outliers":
        return pointCloud("outliers", this.origin, 0xd62850, 3.2);
      case "insidePoles":
        return pointCloud("poles.inside", this.origin, 0x2aa198, 2.6);
      case "outsidePoles":
        return pointCloud("poles.outside", this.origin, 0x9467bd, 2.6);
      case "wireframe":
        return new THREE.Mesh(
          this.geometry,
          new THREE.MeshBasicMaterial({ color: 0x222222, wireframe: true, transparent: true, opacity: 0.35 }),
        );
      case "leftOut":
        return new THREE.Mesh(corners("left_out", this.origin), surfaceMaterial({ color: 0xd62850 }));
    }
    throw new Error(`no layer ${name}`);
  }

  show(name, on) {
    if (on && !this.layers[name]) this.root.add((this.layers[name] = this.#make(name)));
    if (this.layers[name]) this.layers[name].visible = on;
    this.draw();
  }

  paint(what, on) {
    this.colouring[what] = on;
    this.#paint();
    this.draw();
  }

  #paint() {
    const colours = this.geometry.attributes.color;
    const bytesOf = (colour) => [colour.r, colour.g, colour.b].map((c) => Math.round(255 * c));
    const ramp = Array.from({ length: 256 }, (_, s) =>
      bytesOf(
        badSupport
          .clone()
          .lerp(s < 128 ? measuredColour : goodSupport, s < 128 ? s / 127 : 1)
          .lerp(measuredColour, s < 128 ? 0 : (255 - s) / 127),
      ),
    );
    const measured = bytesOf(measuredColour),
      invented = bytesOf(inventedColour);
    for (let t = 0; t < colours.count / 3; ++t) {
      const colour =
        this.colouring.invented && this.marks?.[t]
          ? invented
          : this.colouring.support && this.support
            ? ramp[this.support[t]]
            : measured;
      for (let corner = 0; corner < 3; ++corner) colours.array.set(colour, 9 * t + 3 * corner);
    }
    colours.needsUpdate = true;
  }

  setUp(axis) {
    this.root.rotation.set(...upRotations[axis]);
    this.root.updateMatrixWorld(true);
    this.setCut({});
    this.look("corner");
  }

  look(side) {
    this.controls.target.set(0, 0, 0);
    this.camera.position.set(...sides[side]).setLength(this.radius);
    this.controls.update();
    this.camera.position.setLength(this.#distanceToFit());
    this.controls.update();
    this.draw();
  }

  /** How far away, in the direction in which the camera looks, the whole mesh just fits the picture. */
  #distanceToFit() {
    const right = new THREE.Vector3(),
      up = new THREE.Vector3(),
      back = new THREE.Vector3();
    this.camera.updateMatrixWorld(true);
    this.camera.matrixWorld.extractBasis(right, up, back);
    const tall = Math.tan((this.camera.fov * Math.PI) / 360),
      wide = tall * this.camera.aspect;
    let distance = 0;
    const places = this.geometry.attributes.position,
      step = Math.ceil(places.count / 5000);
    const p = new THREE.Vector3();
    for (let i = 0; i < places.count; i += step) {
      p.fromBufferAttribute(places, i).applyMatrix4(this.root.matrixWorld);
      distance = Math.max(distance, p.dot(back) + Math.max(Math.abs(p.dot(up)) / tall, Math.abs(p.dot(right)) / wide));
    }
    return 1.06 * distance || 1;
  }

  turn(right, up) {
    const place = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target));
    place.theta += right;
    place.phi = Math.min(Math.max(place.phi + up, 0.001), Math.PI - 0.001);
    this.camera.position.setFromSpherical(place).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  /** \return the coordinate at which the plane stands, in the unit of the input */
  setCut(changes) {
    Object.assign(this.cut, changes);
    const { on, axis, place, flipped } = this.cut;
    const normal = new THREE.Vector3().setComponent(axis, flipped ? 1 : -1);
    const level = (place - 0.5) * this.size[axis];
    this.plane.set(normal, flipped ? -level : level).applyMatrix4(this.root.matrixWorld);
    this.renderer.clippingPlanes = on ? [this.plane] : [];
    this.draw();
    return this.low[axis] + place * this.size[axis];
  }

  #resize() {
    const { clientWidth, clientHeight } = this.holder;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.drawNow();
  }

  background(colour) {
    this.scene.background = new THREE.Color(colour);
    this.draw();
  }

  /** At most once a frame, and only when something changed. */
  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    this.waiting = false;
    this.renderer.render(this.scene, this.camera);
  }
}
