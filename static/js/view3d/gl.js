// The WebGL2 painter: bodies with light, their shadow, lines of a width in pixels, and marks that face the eye.

import { colour } from "../colours.js";
import { CELLS, CIRCLE, LOOKS } from "./looks.js";
import { paintMark } from "./marks.js";
import { programs } from "./shaders.js";
import { MESHES } from "./solids.js";
import { clipped, towards, unit } from "./space.js";

const OVERCAST = unit(towards(200, 55));
const LINE_FLOATS = 11;
const MARK_FLOATS = 6;
const CELL_PX = 64;
const SHEET_CELLS = 8;
const ASK_MS = 16;
const LONGEST_MS = 3000;

export class GlPainter {
  // Throws where the browser has no WebGL2, or none just now.
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, stencil: true, powerPreference: "low-power" });
    if (!gl || gl.isContextLost()) throw new Error("This browser gives no WebGL2.");
    this.canvas = canvas;
    this.gl = gl;
    this.programs = programs(gl);
    this.meshes = Object.fromEntries(Object.entries(MESHES).map(([name, faces]) => [name, this.#mesh(faces)]));
    this.lines = this.#stream([[4, 0], [4, 4], [3, 8]], LINE_FLOATS);
    this.still = { ...this.#stream([[4, 0], [4, 4], [3, 8]], LINE_FLOATS), of: null, seen: [], count: 0 };
    this.marks = this.#stream([[4, 0], [2, 4]], MARK_FLOATS);
    this.sheet = { canvas: new OffscreenCanvas(1, 1), texture: gl.createTexture(), cells: new Map() };
    this.rgba = new Map();
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  // Forgets the colours of the theme before.
  repaint() {
    this.rgba.clear();
    this.sheet.cells.clear();
    this.still.of = null;
  }

  paint(stage, camera, ratio) {
    const { gl } = this;
    const [width, height] = [Math.round(camera.width * ratio), Math.round(camera.height * ratio)];
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.disable(gl.DEPTH_TEST);
    this.#ground(camera);
    if (stage.rays) this.#shadow(stage, camera);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    this.#solids(stage, camera);
    this.#stillness(stage.fixed, camera);
    this.#strokes(stage.lines, camera);
    this.#sprites(stage.marks, camera, ratio);
  }

  // Resolves once everything that was ordered is painted, or was not for too long.
  async finished() {
    const { gl } = this;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    const giveUpAt = performance.now() + LONGEST_MS;
    gl.flush();
    while (fence && !gl.isContextLost() && performance.now() < giveUpAt && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) {
      await new Promise((done) => setTimeout(done, ASK_MS));
    }
  }

  #mesh(faces) {
    const { gl } = this;
    const values = [];
    for (const { points, normals } of faces) {
      for (let index = 2; index < points.length; index += 1) {
        for (const corner of [0, index - 1, index]) values.push(...points[corner], ...normals[corner]);
      }
    }
    const array = this.#array([[3, 0], [3, 3]], 6);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
    return { array: array.array, count: values.length / 6 };
  }

  #array(attributes, floats) {
    const { gl } = this;
    const array = gl.createVertexArray();
    const buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    attributes.forEach(([size, begin], index) => {
      gl.enableVertexAttribArray(index);
      gl.vertexAttribPointer(index, size, gl.FLOAT, false, floats * 4, begin * 4);
    });
    return { array, buffer };
  }

  #stream(attributes, floats) {
    return { ...this.#array(attributes, floats), floats };
  }

  #flush(name, stream, values) {
    const { gl } = this;
    gl.useProgram(this.programs[name].made);
    gl.bindVertexArray(stream.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, stream.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.DYNAMIC_DRAW);
    gl.drawArrays(gl.TRIANGLES, 0, values.length / stream.floats);
  }

  #rgba(name) {
    if (!this.rgba.has(name)) this.rgba.set(name, parsed(colour(name)));
    return this.rgba.get(name);
  }

  #ground({ matrix }) {
    const paint = this.#rgba("sunken");
    const middle = clipped(matrix, [0, 0, 0]);
    const values = [];
    for (let index = 1; index < CIRCLE.length; index += 1) {
      for (const corner of [middle, clipped(matrix, CIRCLE[index - 1]), clipped(matrix, CIRCLE[index])]) values.push(...corner, ...paint, 0, 0, 0);
    }
    this.#flush("line", this.lines, values);
  }

  #shadow(stage, { matrix }) {
    const { gl, programs: { shadow } } = this;
    gl.useProgram(shadow.made);
    gl.uniformMatrix4fv(shadow.at.camera, false, matrix);
    gl.uniform3fv(shadow.at.rays, stage.rays);
    gl.uniform4fv(shadow.at.colour, this.#rgba("shade"));
    gl.enable(gl.STENCIL_TEST);
    gl.stencilFunc(gl.EQUAL, 0, 255);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
    for (const solid of stage.solids) this.#draw(shadow, solid);
    gl.disable(gl.STENCIL_TEST);
  }

  #solids(stage, { matrix }) {
    const { gl, programs: { solid: program } } = this;
    gl.useProgram(program.made);
    gl.uniformMatrix4fv(program.at.camera, false, matrix);
    gl.uniform3fv(program.at.light, stage.rays ?? OVERCAST);
    gl.uniform4fv(program.at.front, this.#rgba("cell"));
    gl.uniform4fv(program.at.rib, this.#rgba("cell-line"));
    for (const solid of stage.solids) {
      gl.uniform4fv(program.at.colour, this.#rgba(LOOKS[solid.look]));
      gl.uniform2fv(program.at.cells, solid.look === "panel" ? CELLS : [0, 0]);
      this.#draw(program, solid);
    }
  }

  #draw(program, { mesh, matrix }) {
    const { gl } = this;
    gl.uniformMatrix4fv(program.at.model, false, matrix);
    gl.bindVertexArray(this.meshes[mesh].array);
    gl.drawArrays(gl.TRIANGLES, 0, this.meshes[mesh].count);
  }

  #strokes(lines, camera) {
    const values = [];
    for (const line of lines) stroke(values, line, this.#rgba(line.colour), camera);
    this.#flush("line", this.lines, values);
  }

  // What never moves is measured out anew only when the eye has moved, or the colours are others.
  #stillness(lines, camera) {
    const { gl, still } = this;
    const seen = [...camera.matrix, camera.width, camera.height];
    if (still.of !== lines || seen.some((value, index) => value !== still.seen[index])) {
      const values = [];
      for (const line of lines) stroke(values, line, this.#rgba(line.colour), camera);
      gl.bindBuffer(gl.ARRAY_BUFFER, still.buffer);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
      Object.assign(still, { of: lines, seen, count: values.length / LINE_FLOATS });
    }
    gl.useProgram(this.programs.line.made);
    gl.bindVertexArray(still.array);
    gl.drawArrays(gl.TRIANGLES, 0, still.count);
  }

  #sprites(marks, { matrix, width, height }, ratio) {
    const { gl, sheet } = this;
    const cells = marks.map((mark) => this.#cell(mark, ratio));
    gl.bindTexture(gl.TEXTURE_2D, sheet.texture);
    if (sheet.stale) {
      gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, true);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, sheet.canvas);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
      sheet.stale = false;
    }
    const values = [];
    marks.forEach((mark, index) => {
      const [x, y, z, w] = clipped(matrix, mark.at);
      const [half, rise] = [(CELL_PX / width) * w, (CELL_PX / height) * w];
      const [column, row] = [cells[index] % SHEET_CELLS, Math.floor(cells[index] / SHEET_CELLS)];
      const corner = (u, v) => [x + (2 * u - 1) * half, y + (1 - 2 * v) * rise, z, w, (column + u) / SHEET_CELLS, (row + v) / SHEET_CELLS];
      for (const [u, v] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]]) values.push(...corner(u, v));
    });
    this.#flush("mark", this.marks, values);
  }

  // The number of a mark's cell on the sheet, painted when it is new.
  #cell(mark, ratio) {
    const { sheet } = this;
    const name = `${mark.kind} ${mark.words} ${mark.size} ${mark.weight}`;
    const size = CELL_PX * SHEET_CELLS * ratio;
    if (sheet.canvas.width !== size || sheet.cells.size >= SHEET_CELLS ** 2 || !sheet.cells.size) {
      Object.assign(sheet.canvas, { width: size, height: size });
      sheet.cells.clear();
    }
    if (!sheet.cells.has(name)) {
      const number = sheet.cells.size;
      const pen = sheet.canvas.getContext("2d");
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      paintMark(pen, mark, ((number % SHEET_CELLS) + 0.5) * CELL_PX, (Math.floor(number / SHEET_CELLS) + 0.5) * CELL_PX);
      sheet.cells.set(name, number);
      sheet.stale = true;
    }
    return sheet.cells.get(name);
  }
}

// Adds the triangles of a line of a width in CSS pixels.
function stroke(values, { points, width, dash }, paint, camera) {
  const ends = points.map((point) => clipped(camera.matrix, point));
  const [on, off] = dash ?? [0, 0];
  let run = 0;
  for (let index = 1; index < ends.length; index += 1) {
    const [a, b] = [ends[index - 1], ends[index]];
    const [dx, dy] = [(b[0] / b[3] - a[0] / a[3]) * camera.width / 2, (b[1] / b[3] - a[1] / a[3]) * camera.height / 2];
    const length = Math.hypot(dx, dy);
    if (length < 1e-6) continue;
    const [nx, ny] = [(-dy / length) * width / camera.width, (dx / length) * width / camera.height];
    const corner = (end, side, at) => values.push(end[0] + side * nx * end[3], end[1] + side * ny * end[3], end[2], end[3], ...paint, at, on, off);
    corner(a, -1, run); corner(b, -1, run + length); corner(b, 1, run + length);
    corner(a, -1, run); corner(b, 1, run + length); corner(a, 1, run);
    run += length;
  }
}

const reader = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });

// A colour of the style sheet as red, green, blue and alpha between 0 and 1.
function parsed(text) {
  reader.clearRect(0, 0, 1, 1);
  reader.fillStyle = text;
  reader.fillRect(0, 0, 1, 1);
  return Array.from(reader.getImageData(0, 0, 1, 1).data, (value) => value / 255);
}
