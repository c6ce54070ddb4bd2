// The moving picture: ground with compass, mast, panel, sun, its day arc, the shadow and the ray. Canvas, no library.
// World axes: x east, y north, z up; the ground disc has radius 1.

import { colour } from "./colours.js";

const RAD = Math.PI / 180;
const MAST = 0.4;
const HALF_WIDTH = 0.42;
const HALF_HEIGHT = 0.26;
const SKY = 1.1;
const COLUMNS = 8;
const ROWS = 5;
const TURN_DEG = 30;
const PITCH = { least: 8, most: 75 };

export const towards = (azimuth, elevation, length = 1) => [
  length * Math.sin(azimuth * RAD) * Math.cos(elevation * RAD),
  length * Math.cos(azimuth * RAD) * Math.cos(elevation * RAD),
  length * Math.sin(elevation * RAD),
];
const add = (a, b, factor = 1) => a.map((value, index) => value + factor * b[index]);
// The sky is drawn around the panel, so that its normal meets the sun when it points there.
const inSky = (azimuth, elevation) => add([0, 0, MAST], towards(azimuth, elevation, SKY));

export class PanelScene {
  constructor(canvas) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    this.yaw = Number(canvas.dataset.yaw ?? 152);
    this.pitch = 22;
    this.arc = JSON.parse(canvas.dataset.arc ?? "[]");
    this.wanted = { sun: null, panel: null, target: null };
    this.now = { sun: null, panel: null, target: null };
    this.still = matchMedia("(prefers-reduced-motion: reduce)");
    this.frame = 0;
    this.#listen();
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  // Directions {azimuth, elevation} in degrees, or null for what is not known.
  show(directions) {
    Object.assign(this.wanted, directions);
    this.draw();
  }

  setArc(arc) {
    this.arc = arc;
    this.draw();
  }

  turn(degrees) {
    this.yaw += degrees;
    this.draw();
  }

  draw() {
    if (!this.frame) this.frame = requestAnimationFrame(() => this.#paint());
  }

  #listen() {
    let from = null;
    const { canvas } = this;
    canvas.addEventListener("pointerdown", (event) => { from = event; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointermove", (event) => {
      if (!from) return;
      this.yaw += (event.clientX - from.clientX) * 0.4;
      this.pitch = Math.min(PITCH.most, Math.max(PITCH.least, this.pitch + (event.clientY - from.clientY) * 0.3));
      from = event;
      this.draw();
    });
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => { from = null; });
    addEventListener("theme", () => this.draw());
  }

  // Moves what is shown towards what is wanted; says whether more frames are needed.
  #approach() {
    let moving = false;
    for (const name of Object.keys(this.wanted)) {
      const [goal, at] = [this.wanted[name], this.now[name]];
      if (!goal || !at || this.still.matches) { this.now[name] = goal && { ...goal }; continue; }
      const turn = ((goal.azimuth - at.azimuth + 540) % 360) - 180;
      const lift = goal.elevation - at.elevation;
      if (Math.abs(turn) + Math.abs(lift) < 0.01 || Math.abs(turn) > 60) { this.now[name] = { ...goal }; continue; }
      at.azimuth += turn * 0.3;
      at.elevation += lift * 0.3;
      moving = true;
    }
    return moving;
  }

  #paint() {
    this.frame = 0;
    const moving = this.#approach();
    const ratio = Math.min(2, devicePixelRatio || 1);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    if (this.canvas.width !== Math.round(width * ratio)) this.canvas.width = Math.round(width * ratio);
    if (this.canvas.height !== Math.round(height * ratio)) this.canvas.height = Math.round(height * ratio);
    this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.pen.clearRect(0, 0, width, height);
    this.size = Math.min(width / 2.5, height / 2.05);
    this.middle = [width / 2, height * 0.74];
    this.#scene();
    if (moving) this.draw();
  }

  at([x, y, z]) {
    const [sinYaw, cosYaw] = [Math.sin(this.yaw * RAD), Math.cos(this.yaw * RAD)];
    const [sinPitch, cosPitch] = [Math.sin(this.pitch * RAD), Math.cos(this.pitch * RAD)];
    const right = -x * cosYaw + y * sinYaw;
    const near = x * sinYaw + y * cosYaw;
    const depth = near * cosPitch + z * sinPitch;
    const scale = this.size / (1 - depth * 0.11);
    return [this.middle[0] + right * scale, this.middle[1] - (z * cosPitch - near * sinPitch) * scale, depth];
  }

  line(points, close = false) {
    this.pen.beginPath();
    points.forEach((point, index) => {
      const [x, y] = this.at(point);
      if (index) this.pen.lineTo(x, y); else this.pen.moveTo(x, y);
    });
    if (close) this.pen.closePath();
  }

  stroke(name, width = 1, dash = []) {
    Object.assign(this.pen, { strokeStyle: colour(name), lineWidth: width, lineCap: "round", lineJoin: "round" });
    this.pen.setLineDash(dash);
    this.pen.stroke();
    this.pen.setLineDash([]);
  }

  fill(name) {
    this.pen.fillStyle = colour(name);
    this.pen.fill();
  }

  text(words, point, { size = 14, weight = 600, name = "text" } = {}) {
    const [x, y] = this.at(point);
    Object.assign(this.pen, { font: `${weight} ${size}px ${getComputedStyle(document.body).fontFamily}`, textAlign: "center", textBaseline: "middle", fillStyle: colour(name) });
    this.pen.fillText(words, x, y);
  }

  #scene() {
    const { sun, panel, target } = this.now;
    this.#ground();
    if (sun && panel && sun.elevation > 1.5) this.#shadow(sun, panel);
    this.#arc(false);
    const behind = sun && this.at(inSky(sun.azimuth, sun.elevation))[2] < 0;
    if (sun && behind) this.#sun(sun);
    this.#mast();
    if (target && panel && Math.abs(target.elevation - panel.elevation) + Math.abs(target.azimuth - panel.azimuth) > 1) this.#outline(target);
    if (panel) this.#panel(panel, sun);
    this.#arc(true);
    if (sun && !behind) this.#sun(sun);
  }

  #ground() {
    const ring = (radius) => Array.from({ length: 73 }, (_, index) => towards(index * 5, 0, radius));
    this.line(ring(1), true);
    this.fill("sunken");
    this.stroke("line", 1.5);
    this.line(ring(0.5), true);
    this.stroke("hair", 1);
    for (let azimuth = 0; azimuth < 360; azimuth += 10) {
      this.line([towards(azimuth, 0, azimuth % 30 ? 0.965 : 0.93), towards(azimuth, 0, 1)]);
      this.stroke("line", azimuth % 30 ? 1 : 2);
    }
    for (const azimuth of [0, 90]) {
      this.line([towards(azimuth, 0, 1), towards(azimuth + 180, 0, 1)]);
      this.stroke("hair", 1.2);
    }
    ["N", "E", "S", "W"].forEach((letter, index) => this.text(letter, towards(index * 90, 0, 1.12), { size: 17, weight: 700 }));
  }

  #corners({ azimuth, elevation }) {
    const right = [Math.cos(azimuth * RAD), -Math.sin(azimuth * RAD), 0];
    const up = [-Math.sin(azimuth * RAD) * Math.sin(elevation * RAD), -Math.cos(azimuth * RAD) * Math.sin(elevation * RAD), Math.cos(elevation * RAD)];
    const middle = add([0, 0, MAST], towards(azimuth, elevation, 0.05));
    const at = (u, v) => add(add(middle, right, u * HALF_WIDTH), up, v * HALF_HEIGHT);
    return { middle, at, outline: [at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)] };
  }

  #shadow(sun, panel) {
    const ray = towards(sun.azimuth, sun.elevation);
    const drop = (point) => add(point, ray, -point[2] / ray[2]);
    this.pen.save();
    this.line(Array.from({ length: 73 }, (_, index) => towards(index * 5, 0, 1)), true);
    this.pen.clip();
    this.line(this.#corners(panel).outline.map(drop), true);
    this.fill("shade");
    this.line([[0, 0, 0], drop([0, 0, MAST])]);
    this.stroke("shade", 5);
    this.pen.restore();
  }

  #mast() {
    this.line(Array.from({ length: 25 }, (_, index) => towards(index * 15, 0, 0.07)), true);
    this.fill("metal");
    this.stroke("outline", 1.5);
    this.line([[0, 0, 0], [0, 0, MAST]]);
    this.stroke("outline", 10);
    this.line([[0, 0, 0], [0, 0, MAST]]);
    this.stroke("metal", 6.5);
  }

  #outline(direction) {
    this.line(this.#corners(direction).outline, true);
    this.stroke("second", 2, [7, 6]);
  }

  #panel(panel, sun) {
    const { middle, at, outline } = this.#corners(panel);
    const normal = towards(panel.azimuth, panel.elevation);
    const eye = towards(this.yaw, this.pitch);
    const front = normal[0] * eye[0] + normal[1] * eye[1] + normal[2] * eye[2] > 0;
    this.line(outline, true);
    this.fill(front ? "cell" : "metal");
    this.pen.globalAlpha = front ? 0.75 : 0.35;
    for (let column = 1; column < COLUMNS; column += 1) this.#rib(at, column / COLUMNS * 2 - 1, true, front);
    for (let row = 1; row < ROWS; row += 1) this.#rib(at, row / ROWS * 2 - 1, false, front);
    this.pen.globalAlpha = 1;
    this.line(outline, true);
    this.stroke("outline", 2.5);
    this.#ray(middle, normal, sun);
  }

  #rib(at, where, upright, front) {
    this.line(upright ? [at(where, -1), at(where, 1)] : [at(-1, where), at(1, where)]);
    this.stroke(front ? "cell-line" : "outline", 1);
  }

  #ray(middle, normal, sun) {
    if (sun && sun.elevation > -1) {
      this.line([middle, inSky(sun.azimuth, sun.elevation)]);
      this.stroke("text", 1.2, [2, 5]);
    }
    const tip = add(middle, normal, 0.5);
    this.line([middle, tip]);
    this.stroke("blue", 4);
    this.pen.beginPath();
    const [x, y] = this.at(tip);
    this.pen.arc(x, y, 5, 0, 2 * Math.PI);
    this.fill("blue");
  }

  #arc(nearSide) {
    let points = [];
    const flush = () => {
      if (points.length > 1) { this.line(points); this.stroke("second", 2); }
      points = [];
    };
    for (const [azimuth, elevation] of this.arc) {
      const point = inSky(azimuth, elevation);
      if (elevation < -0.9 || this.at(point)[2] >= 0 !== nearSide) { if (points.length) points.push(point); flush(); continue; }
      points.push(point);
    }
    flush();
  }

  #sun({ azimuth, elevation }) {
    const [x, y] = this.at(inSky(azimuth, elevation));
    const up = elevation > -0.9;
    if (up) this.#beams(x, y);
    this.pen.beginPath();
    this.pen.arc(x, y, 13, 0, 2 * Math.PI);
    this.fill(up ? "sun-disc" : "ground");
    this.stroke("outline", 3, up ? [] : [4, 4]);
    if (up) {
      this.line([inSky(azimuth, elevation), towards(azimuth, 0, SKY * Math.cos(elevation * RAD))]);
      this.pen.globalAlpha = 0.35;
      this.stroke("line", 1, [3, 5]);
      this.pen.globalAlpha = 1;
    }
  }

  #beams(x, y) {
    this.pen.beginPath();
    for (let index = 0; index < 12; index += 1) {
      const angle = (index * Math.PI) / 6;
      this.pen.moveTo(x + 18 * Math.cos(angle), y + 18 * Math.sin(angle));
      this.pen.lineTo(x + 23 * Math.cos(angle), y + 23 * Math.sin(angle));
    }
    this.stroke("outline", 2);
  }
}

// Two keys that do what dragging does, for fingers in gloves and for the keyboard.
export function turnKeys(scene) {
  const holder = document.createElement("div");
  holder.className = "scene-keys";
  for (const [words, sign, degrees] of [["Turn the view left", "⟲", TURN_DEG], ["Turn the view right", "⟳", -TURN_DEG]]) {
    const key = document.createElement("button");
    key.type = "button";
    key.className = "key";
    key.setAttribute("aria-label", words);
    key.textContent = sign;
    key.addEventListener("click", () => scene.turn(degrees));
    holder.append(key);
  }
  scene.canvas.after(holder);
}
