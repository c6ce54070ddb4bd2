// Signature fields: strokes are kept as points of a field of 1000 x 300, so that they print as lines on any paper.

const NEAR = 4;

const drawnOf = (pad) => pad.closest("form").elements[`${pad.dataset.signPad}_drawn`];

function strokesOf(pad) {
  try {
    return JSON.parse(drawnOf(pad).value || "[]");
  } catch {
    return [];
  }
}

function draw(pad, strokes) {
  const paper = pad.getContext("2d");
  paper.clearRect(0, 0, pad.width, pad.height);
  paper.strokeStyle = "#000";
  paper.lineWidth = 5;
  paper.lineCap = paper.lineJoin = "round";
  for (const [first, ...rest] of strokes) {
    paper.beginPath();
    paper.moveTo(...first);
    for (const point of rest) paper.lineTo(...point);
    paper.stroke();
  }
}

function place(pad, event) {
  const box = pad.getBoundingClientRect();
  const within = (value, most) => Math.max(0, Math.min(most, Math.round(value)));
  return [within(((event.clientX - box.left) / box.width) * pad.width, pad.width), within(((event.clientY - box.top) / box.height) * pad.height, pad.height)];
}

function watch(pad) {
  if (pad.dataset.ready) return;
  pad.dataset.ready = "yes";
  let strokes = strokesOf(pad);
  let pen = null;
  const keep = () => {
    drawnOf(pad).value = JSON.stringify(strokes.filter((stroke) => stroke.length > 1));
    draw(pad, strokes);
  };
  pad.addEventListener("pointerdown", (event) => {
    if (pen !== null) return;
    event.preventDefault();
    pen = event.pointerId;
    pad.setPointerCapture(pen);
    strokes.push([place(pad, event)]);
  });
  pad.addEventListener("pointermove", (event) => {
    if (event.pointerId !== pen) return;
    const stroke = strokes[strokes.length - 1];
    const [x, y] = place(pad, event);
    const [lastX, lastY] = stroke[stroke.length - 1];
    if (Math.hypot(x - lastX, y - lastY) < NEAR) return;
    stroke.push([x, y]);
    draw(pad, strokes);
  });
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
    pad.addEventListener(name, (event) => {
      if (event.pointerId !== pen) return;
      pen = null;
      keep();
    });
  }
  pad.closest("form").querySelector(`[data-sign-clear="${pad.dataset.signPad}"]`).addEventListener("click", () => {
    strokes = [];
    keep();
  });
  // What was drawn before a reload comes back into the field (keep.js), and is drawn again.
  pad.closest("form").addEventListener("input", ({ target, currentTarget }) => {
    if (target !== currentTarget) return;
    strokes = strokesOf(pad);
    draw(pad, strokes);
  });
  draw(pad, strokes);
}

const start = () => document.querySelectorAll("[data-sign-pad]").forEach(watch);

document.addEventListener("htmx:after:swap", start);
start();
