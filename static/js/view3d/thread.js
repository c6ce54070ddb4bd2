// The WebGL2 painter as the page sees it: what is to be painted goes to a worker, so that no key waits for the picture.

import { looks } from "../colours.js";

const IN_FLIGHT = 2;

export class ThreadPainter {
  // `told`: what to do when it is `ready`, when there is `none`, when it was `lost`, and, with the milliseconds it took, has `painted`.
  // Throws where a canvas cannot be given to a worker.
  constructor(canvas, first, told) {
    const given = canvas.transferControlToOffscreen();
    this.canvas = canvas;
    this.fixed = null;
    this.sentAt = [];
    this.worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
    this.worker.addEventListener("error", () => told.none());
    this.worker.addEventListener("message", ({ data }) => {
      if (data === "painted") told.painted(performance.now() - this.sentAt.shift()); else told[data]();
    });
    this.#send({ order: "begin", canvas: given, looks: looks(), ...this.#parts(...first) }, [given]);
  }

  // Whether it has enough to do just now.
  get busy() {
    return this.sentAt.length >= IN_FLIGHT;
  }

  repaint() {
    this.#send({ order: "looks", looks: looks() });
  }

  paint(stage, camera, sharpness) {
    this.sentAt.push(performance.now());
    this.#send({ order: "paint", ...this.#parts(stage, camera, sharpness) });
  }

  #send(order, given = []) {
    this.worker.postMessage(order, given);
  }

  #parts(stage, camera, sharpness) {
    const fixed = stage.fixed === this.fixed ? null : stage.fixed;
    this.fixed = stage.fixed;
    return { stage: { ...stage, fixed }, camera, sharpness };
  }
}
