// The drawn view, where there is no WebGL: the same scene on a plain canvas, faces sorted from back to front.

import { colour } from "../colours.js";
import { CELLS, CIRCLE, LOOKS } from "./looks.js";
import { paintMark } from "./marks.js";
import { MESHES } from "./solids.js";
import { add, clipped, dot, moved } from "./space.js";

export class DrawnPainter {
  // `painted`: told after each picture how many milliseconds it took until the next could begin.
  constructor(canvas, painted) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    this.painted = painted;
    this.busy = false;
  }

  // Keeps nothing of a theme: colours are read at every painting.
  repaint() {}

  paint(stage, camera, ratio) {
    const { canvas, pen } = this;
    const begun = performance.now();
    requestAnimationFrame(() => this.painted(performance.now() - begun));
    const [width, height] = [Math.round(camera.width * ratio), Math.round(camera.height * ratio)];
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, camera.width, camera.height);
    this.camera = camera;
    this.#trace(CIRCLE, true);
    this.#fill("sunken");
    if (stage.rays) this.#shadow(stage);
    const lines = this.#sorted([...stage.fixed, ...stage.lines]);
    lines.far.forEach((line) => this.#stroke(line));
    const marks = this.#sorted(stage.marks.map((mark) => ({ ...mark, points: [mark.at] })));
    marks.far.forEach((mark) => this.#mark(mark));
    this.#faces(stage).forEach((face) => this.#face(face));
    lines.near.forEach((line) => this.#stroke(line));
    marks.near.forEach((mark) => this.#mark(mark));
  }

  // What lies behind the middle of the scene, and what lies before it or above the ground's middle.
  #sorted(things) {
    const depth = ({ points }) => dot(points[Math.floor(points.length / 2)], this.camera.eye);
    return { far: things.filter((one) => depth(one) < 0.25), near: things.filter((one) => depth(one) >= 0.25) };
  }

  #at(point) {
    const [x, y, , w] = clipped(this.camera.matrix, point);
    return [((x / w + 1) * this.camera.width) / 2, ((1 - y / w) * this.camera.height) / 2];
  }

  #trace(points, close = false) {
    this.pen.beginPath();
    points.forEach((point, index) => {
      const [x, y] = this.#at(point);
      if (index) this.pen.lineTo(x, y); else this.pen.moveTo(x, y);
    });
    if (close) this.pen.closePath();
  }

  #fill(name) {
    this.pen.fillStyle = colour(name);
    this.pen.fill();
  }

  #stroke({ points, colour: name, width, dash }) {
    this.#trace(points);
    Object.assign(this.pen, { strokeStyle: colour(name), lineWidth: width, lineCap: "round", lineJoin: "round" });
    this.pen.setLineDash(dash ?? []);
    this.pen.stroke();
    this.pen.setLineDash([]);
  }

  #mark(mark) {
    paintMark(this.pen, mark, ...this.#at(mark.at));
  }

  #faces({ solids }) {
    const seen = [];
    for (const { mesh, matrix, look } of solids) {
      for (const face of MESHES[mesh]) {
        const points = face.points.map((point) => moved(matrix, point));
        const normal = turnedNormal(matrix, face.normal);
        const towardsEye = add(this.camera.eye, points[0], -1);
        if (dot(normal, towardsEye) <= 0) continue;
        const front = look === "panel" && face.normal[2] > 0;
        // A wide panel's middle says little of what lies before it: its front goes later, its back sooner.
        const sooner = look === "panel" ? (front ? -0.2 : 0.2) : 0;
        seen.push({ points, matrix, look, front, far: Math.hypot(...add(this.camera.eye, middle(points), -1)) + sooner });
      }
    }
    return seen.sort((a, b) => b.far - a.far);
  }

  #face({ points, matrix, look, front }) {
    this.#trace(points, true);
    this.#fill(front ? "cell" : LOOKS[look]);
    if (front) this.#ribs(matrix);
    this.#stroke({ points: [...points, points[0]], colour: "outline", width: 0.6 });
  }

  #ribs(matrix) {
    CELLS.forEach((count, across) => {
      for (let index = 1; index < count; index += 1) {
        const at = index / count - 0.5;
        const ends = [-0.5, 0.5].map((far) => moved(matrix, across ? [far, at, 0.5] : [at, far, 0.5]));
        this.#stroke({ points: ends, colour: "cell-line", width: 0.8 });
      }
    });
  }

  #shadow({ solids, rays }) {
    const { pen } = this;
    const thrown = (point) => add(point, rays, -point[2] / rays[2]);
    pen.save();
    this.#trace(CIRCLE, true);
    pen.clip();
    const shade = new Path2D();
    for (const { mesh, matrix } of solids) {
      for (const face of MESHES[mesh]) shade.addPath(this.#path(face.points.map((point) => thrown(moved(matrix, point)))));
    }
    pen.fillStyle = colour("shade");
    pen.fill(shade);
    pen.restore();
  }

  // A closed path that runs the same way round whatever face it comes from, so that overlaps do not cut holes.
  #path(points) {
    const spots = points.map((point) => this.#at(point));
    const area = spots.reduce((sum, [x, y], index) => { const [nx, ny] = spots[(index + 1) % spots.length]; return sum + x * ny - nx * y; }, 0);
    const path = new Path2D();
    (area < 0 ? spots.reverse() : spots).forEach(([x, y], index) => { if (index) path.lineTo(x, y); else path.moveTo(x, y); });
    path.closePath();
    return path;
  }
}

const middle = (points) => points.reduce((sum, point) => add(sum, point, 1 / points.length), [0, 0, 0]);

// A normal under a body's matrix, whose columns are square to each other.
function turnedNormal(m, [x, y, z]) {
  const size = [0, 4, 8].map((at) => m[at] ** 2 + m[at + 1] ** 2 + m[at + 2] ** 2);
  const [a, b, c] = [x / size[0], y / size[1], z / size[2]];
  return [m[0] * a + m[4] * b + m[8] * c, m[1] * a + m[5] * b + m[9] * c, m[2] * a + m[6] * b + m[10] * c];
}
