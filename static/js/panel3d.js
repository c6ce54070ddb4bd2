// The moving picture: the panel on its mount with sun, shadow, compass, limits and the day's path.
// It paints only when something changes. WebGL2 in a worker where the browser has it, else the drawn view of the same scene.

import { PITCH, cameraAt } from "./view3d/camera.js";
import { DrawnPainter } from "./view3d/drawn.js";
import { anglesOf, stageOf, viewOf } from "./view3d/stage.js";
import { ThreadPainter } from "./view3d/thread.js";
import { _ } from "./i18n.js";

const TURN_DEG = 15;
const TILT_DEG = 11;
const SETTLE_MS = 90;
const SETTLED_DEG = 0.01;
const LEAP_DEG = 60;
const ALIKE_DEG = 0.02;
const SHARPEST = 2;
const SLOW_MS = 24;
const AWAY_MS = 1000;
const TRIAL = { sun: { azimuth: 180, elevation: 45 }, panel: { first: 0, second: 45 }, target: null };

export class PanelScene {
  // `settle`: whether the panel glides to what is new, or is there at once (a recording that plays is smooth by itself).
  constructor(holder, { settle = true } = {}) {
    this.holder = holder;
    this.view = viewOf(JSON.parse(holder.dataset.view));
    this.turned = { yaw: this.view.yaw, pitch: PITCH.first };
    this.wanted = { sun: null, panel: null, target: null };
    this.now = { sun: null, panel: null, target: null };
    this.still = matchMedia("(prefers-reduced-motion: reduce)");
    this.settle = settle;
    this.frame = 0;
    this.paintedAt = 0;
    this.late = false;
    this.seen = false;
    this.sharpness = SHARPEST;
    this.pacedMs = 0;
    this.begun = false;
    this.painter = null;
    this.#listen();
  }

  // Directions {azimuth, elevation} in degrees, or null for what is not known.
  show({ sun, panel, target }) {
    const on = (direction) => direction && anglesOf(this.view.mount, direction);
    const wanted = { sun: sun && { first: sun.azimuth, second: sun.elevation }, panel: on(panel), target: on(target) };
    const same = Object.entries(wanted).every(([name, direction]) => alike(direction, this.wanted[name]));
    if (same && this.paintedAt) return;
    this.wanted = wanted;
    this.draw();
  }

  turn(yaw, pitch) {
    this.turned.yaw += yaw;
    this.turned.pitch = Math.min(PITCH.most, Math.max(PITCH.least, this.turned.pitch + pitch));
    this.draw();
  }

  draw() {
    if (!this.frame && this.seen && this.painter) this.frame = requestAnimationFrame((at) => this.#paint(at));
  }

  // What is painted next, as plain data.
  stage() {
    const { sun, panel, target } = this.now;
    return stageOf(this.view, { sun: sun && { azimuth: sun.first, elevation: sun.second }, panel, target });
  }

  #canvas() {
    const canvas = document.createElement("canvas");
    canvas.className = "scene-canvas";
    canvas.setAttribute("aria-hidden", "true");
    return canvas;
  }

  // It is shown when the worker is ready, and the drawn view where it never will be or while it has lost its context.
  #begin() {
    const first = [stageOf(this.view, TRIAL), cameraAt(this.turned, this.holder.clientWidth || 1, this.holder.clientHeight || 1), this.#sharp()];
    try {
      const painter = new ThreadPainter(this.#canvas(), first, {
        ready: () => this.#use(painter, "webgl2"),
        none: () => this.#useDrawn(),
        lost: () => this.#useDrawn(),
        painted: (tookMs) => this.#painted(tookMs),
      });
    } catch {
      this.#useDrawn();
    }
  }

  #useDrawn() {
    this.#use(new DrawnPainter(this.#canvas(), (tookMs) => this.#painted(tookMs)), "drawn");
  }

  #use(painter, name) {
    this.painter = painter;
    this.holder.dataset.painter = name;
    this.holder.replaceChildren(painter.canvas);
    painter.repaint();
    this.draw();
  }

  #listen() {
    const { holder } = this;
    let from = null;
    holder.addEventListener("pointerdown", (event) => { from = event; holder.setPointerCapture(event.pointerId); });
    holder.addEventListener("pointermove", (event) => {
      if (from?.pointerId !== event.pointerId) return;
      this.turn((event.clientX - from.clientX) * 0.4, (event.clientY - from.clientY) * 0.3);
      from = event;
    });
    for (const name of ["pointerup", "pointercancel"]) holder.addEventListener(name, () => { from = null; });
    holder.addEventListener("keydown", (event) => this.#key(event));
    addEventListener("theme", () => { this.painter?.repaint(); this.draw(); });
    new ResizeObserver(() => this.draw()).observe(holder);
    new IntersectionObserver((seen) => this.#look(seen.at(-1).isIntersecting)).observe(holder);
  }

  // What is below the screen's edge is not painted, and not even prepared.
  #look(seen) {
    this.seen = seen;
    if (seen && !this.begun) {
      this.begun = true;
      this.#begin();
    }
    this.draw();
  }

  #key(event) {
    const turn = KEYS[event.key];
    if (!turn || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (event.key === "Home") this.turned = { yaw: this.view.yaw, pitch: PITCH.first };
    this.turn(...turn);
  }

  // Moves what is shown towards what is wanted; says whether more frames are needed.
  #approach(passedMs) {
    const share = this.still.matches || !this.settle ? 1 : 1 - Math.exp(-passedMs / SETTLE_MS);
    let moving = false;
    for (const name of Object.keys(this.wanted)) {
      const [goal, at] = [this.wanted[name], this.now[name]];
      const turn = goal && at && ((goal.first - at.first + 540) % 360) - 180;
      const lift = goal && at && goal.second - at.second;
      const far = goal && at ? Math.abs(turn) + Math.abs(lift) : 0;
      if (share === 1 || far < SETTLED_DEG || far > LEAP_DEG) { this.now[name] = goal && { ...goal }; continue; }
      this.now[name] = { first: at.first + turn * share, second: at.second + lift * share };
      moving = true;
    }
    return moving;
  }

  #sharp() {
    return Math.min(this.sharpness, devicePixelRatio || 1);
  }

  // A device that cannot keep up with a fine picture gets a coarser one, down to one point for each of the page's.
  #pace(tookMs) {
    if (tookMs > AWAY_MS || this.#sharp() <= 1) return;
    this.pacedMs += (tookMs - this.pacedMs) / 16;
    if (this.pacedMs <= SLOW_MS) return;
    this.sharpness = Math.max(1, this.#sharp() - 0.5);
    this.pacedMs = 0;
  }

  #paint(at) {
    this.frame = 0;
    const { clientWidth: width, clientHeight: height } = this.holder;
    this.late = this.painter.busy;
    if (!width || !height || this.late) return;
    const moving = this.#approach(Math.min(100, Math.max(8, at - this.paintedAt)));
    this.paintedAt = at;
    this.painter.paint(this.stage(), cameraAt(this.turned, width, height), this.#sharp());
    if (moving) this.draw();
  }

  // Tells of a picture that is on the screen; one that waited for it is painted next.
  #painted(tookMs) {
    this.holder.dataset.frames = String(Number(this.holder.dataset.frames ?? 0) + 1);
    this.#pace(tookMs);
    if (this.late) this.draw();
  }
}

// Whether two directions look the same in the picture: the sun creeps on all day, and nobody sees a hundredth of a degree.
function alike(a, b) {
  if (!a || !b) return !a && !b;
  return Math.abs(a.first - b.first) + Math.abs(a.second - b.second) < ALIKE_DEG;
}

const KEYS = { ArrowLeft: [-TURN_DEG, 0], ArrowRight: [TURN_DEG, 0], ArrowUp: [0, TILT_DEG], ArrowDown: [0, -TILT_DEG], Home: [0, 0] };
const KEY_WORDS = [[_("Turn the view left"), "⟲", "ArrowRight"], [_("Lower the viewpoint"), "▽", "ArrowDown"], [_("Raise the viewpoint"), "△", "ArrowUp"], [_("Turn the view right"), "⟳", "ArrowLeft"]];

// Keys that do what dragging does, for fingers in gloves.
export function turnKeys(scene) {
  const keys = document.createElement("div");
  keys.className = "scene-keys";
  for (const [words, sign, name] of KEY_WORDS) {
    const key = document.createElement("button");
    key.type = "button";
    key.className = "key";
    key.setAttribute("aria-label", words);
    key.textContent = sign;
    key.addEventListener("click", () => scene.turn(...KEYS[name]));
    keys.append(key);
  }
  scene.holder.after(keys);
}
