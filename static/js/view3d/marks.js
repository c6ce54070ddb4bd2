// Letters, numbers and the sun, painted on a plain canvas for both painters.

import { colour, font } from "../colours.js";

const BEAMS = 12;

// Paints a mark about the middle (x, y) of a 2-D context.
export function paintMark(pen, mark, x, y) {
  if (mark.kind === "text") paintText(pen, mark, x, y); else paintSun(pen, mark, x, y);
}

function paintText(pen, { words, size, weight }, x, y) {
  Object.assign(pen, { font: `${weight} ${size}px ${font()}`, textRendering: "geometricPrecision", textAlign: "center", textBaseline: "middle",
    lineJoin: "round", strokeStyle: colour("panel"), lineWidth: 4, fillStyle: colour("text") });
  pen.setLineDash([]);
  pen.strokeText(words, x, y);
  pen.fillText(words, x, y);
}

function paintSun(pen, { kind, size }, x, y) {
  const radius = size / 2;
  Object.assign(pen, { strokeStyle: colour("outline"), lineWidth: 2, lineCap: "round", fillStyle: colour(kind === "sun" ? "sun-disc" : "ground") });
  pen.setLineDash([]);
  pen.beginPath();
  for (let index = 0; kind === "sun" && index < BEAMS; index += 1) {
    const turn = (index * 2 * Math.PI) / BEAMS;
    pen.moveTo(x + (radius + 5) * Math.cos(turn), y + (radius + 5) * Math.sin(turn));
    pen.lineTo(x + (radius + 10) * Math.cos(turn), y + (radius + 10) * Math.sin(turn));
  }
  pen.stroke();
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  pen.lineWidth = 3;
  pen.setLineDash(kind === "sun" ? [] : [4, 4]);
  pen.fill();
  pen.stroke();
  pen.setLineDash([]);
}
