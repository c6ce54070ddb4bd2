// From where the scene is looked at: the eye turns about a point above the ground's middle.

import { add, lens, looking, product, RAD, towards } from "./space.js";

const FIELD_DEG = 26;
const HALF_HEIGHT = 1;
const HALF_WIDTH = 1.14;
const MIDDLE = [0, 0, 0.42];

export const PITCH = { least: 4, most: 88, first: 22 };

// The matrix into clip space, the eye, and the size of the picture in CSS pixels.
export function cameraAt({ yaw, pitch }, width, height) {
  const half = Math.tan((FIELD_DEG / 2) * RAD);
  const distance = Math.max(HALF_HEIGHT / half + 0.45, HALF_WIDTH / (half * (width / height)) + 0.3);
  const eye = add(MIDDLE, towards(yaw, pitch, distance));
  const matrix = product(lens(FIELD_DEG, width / height, distance - 2, distance + 2), looking(eye, MIDDLE));
  return { matrix, eye, width, height };
}
