// The picture of the panel on live pages.

import { live } from "./live.js";
import { PanelScene, turnKeys } from "./panel3d.js";
import { panelOf, sunOf } from "./sunpath.js";

export const targetOf = (one) => one?.target && { azimuth: one.target.azimuth_deg, elevation: one.target.elevation_deg };

for (const holder of document.querySelectorAll("[data-scene]")) {
  const scene = new PanelScene(holder);
  turnKeys(scene);
  live.on("state", () => scene.show({ sun: sunOf(live.tracker), panel: panelOf(live.tracker), target: targetOf(live.tracker) }));
}
