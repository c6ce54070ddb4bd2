// Paints with WebGL2 in a thread of its own. Told: begin, looks, paint. Tells: ready, none, lost, painted.

import { takeLooks } from "../colours.js";
import { GlPainter } from "./gl.js";

const LETTERS = [
  ["Heliopanel", "200 800", "atkinson/5.3.0/atkinson-hyperlegible-next-latin-wght-normal.woff2"],
  ["Heliopanel Chinese", "600", "noto/5.3.0/noto-sans-sc-few-600.woff2"],
];
let painter = null;
let fixed = [];
const letters = Promise.allSettled(LETTERS.map(load));

const ORDERS = {
  // The first picture is for nobody: the driver builds what painting needs.
  begin({ canvas, ...first }) {
    takeLooks(first.looks);
    canvas.addEventListener("webglcontextlost", (event) => { event.preventDefault(); painter = null; postMessage("lost"); });
    canvas.addEventListener("webglcontextrestored", () => open(canvas));
    open(canvas, first);
  },
  looks({ looks }) {
    takeLooks(looks);
    painter?.repaint();
  },
  paint(order) {
    paint(order);
    requestAnimationFrame(() => postMessage("painted"));
  },
};

async function open(canvas, first) {
  await letters;
  try {
    painter = new GlPainter(canvas);
  } catch {
    postMessage("none");
    return;
  }
  if (first) {
    paint(first);
    await painter.finished();
  }
  postMessage("ready");
}

// A worker has none of the page's fonts: it loads the letters of its labels itself. One that does not come is done without.
async function load([family, weight, file]) {
  const letters = new FontFace(family, `url(${new URL(`../../vendor/${file}`, import.meta.url)})`, { weight });
  fonts.add(letters);
  await letters.load();
}

// What never moves comes when it has changed.
function paint({ stage, camera, sharpness }) {
  fixed = stage.fixed ?? fixed;
  painter?.paint({ ...stage, fixed }, camera, sharpness);
}

addEventListener("message", ({ data }) => ORDERS[data.order](data));
