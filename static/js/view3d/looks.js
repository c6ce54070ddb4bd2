// What both painters know of looks: the colour of each kind of body, the panel's grid, the rim of the ground.

import { towards } from "./space.js";

export const LOOKS = { panel: "metal", metal: "metal", dark: "key-border" };
export const CELLS = [8, 5];
export const CIRCLE = Array.from({ length: 73 }, (_, index) => towards(index * 5, 0));
