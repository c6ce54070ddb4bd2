// Step 1: the cross on the map, and the device's own position where the browser gives it.

import { _ } from "./i18n.js";

const cross = document.getElementById("map-cross");
const preview = document.getElementById("preview");
let typing = null;

function moveCross() {
  const found = preview.querySelector("[data-x]");
  cross.setAttribute("visibility", found ? "visible" : "hidden");
  if (!found) return;
  cross.setAttribute("transform", `translate(${found.dataset.x} ${found.dataset.y})`);
  press("latitude", found.dataset.latitudeSide);
  press("longitude", found.dataset.longitudeSide);
  divide(found.dataset);
  const byPlace = document.querySelector('#f-time_zone option[value=""]');
  if (byPlace && document.getElementById("f-time_zone").value === "") byPlace.textContent = found.dataset.zone;
}

// A pair in one field goes to both, unless that field is still being typed in.
function divide({ latitude, longitude }) {
  if (!latitude || (typing && typing === document.activeElement)) return;
  for (const [name, text] of Object.entries({ latitude, longitude })) document.getElementById(`f-${name}`).value = text;
  document.getElementById("f-latitude").dispatchEvent(new Event("input", { bubbles: true }));
}

function put(name, value, sides) {
  document.getElementById(`f-${name}`).value = Math.abs(value).toFixed(5);
  press(name, value < 0 ? sides[1] : sides[0]);
}

function press(name, side) {
  const key = document.querySelector(`input[name="${name}_side"][value="${side}"]`);
  if (key) key.checked = true;
}

function take(position, words) {
  const { latitude, longitude, altitude, accuracy } = position.coords;
  put("latitude", latitude, "NS");
  put("longitude", longitude, "EW");
  if (altitude !== null) document.getElementById("f-altitude").value = Math.round(altitude);
  words.textContent = _("Location taken, accurate to {metres} m. Check it, then save.", { metres: Math.round(accuracy) });
  document.body.dispatchEvent(new CustomEvent("location-typed"));
}

const REFUSED = {
  1: _("The browser was not allowed to share its location. Allow location access in the browser, or enter the coordinates."),
  2: _("This device does not know its location now. Enter the coordinates."),
  3: _("This device found no location within 20 s. Try again under the open sky, or enter the coordinates."),
};

function offerDevicePlace() {
  const holder = document.getElementById("device-place");
  if (!holder) return;
  const [key, words] = [holder.querySelector("button"), holder.querySelector("p")];
  if (!window.isSecureContext || !navigator.geolocation) {
    words.textContent = _("This browser shares its location only with pages over HTTPS or on the same computer. Enter the coordinates, or paste them as “41.2867, 36.3300”.");
    return;
  }
  words.textContent = "";
  key.disabled = false;
  key.addEventListener("click", () => {
    words.textContent = _("Finding the location …");
    navigator.geolocation.getCurrentPosition((found) => take(found, words), (error) => { words.textContent = REFUSED[error.code] ?? error.message; },
      { enableHighAccuracy: true, timeout: 20000, maximumAge: 0 });
  });
}

function tellDeviceZone() {
  const field = document.getElementById("device-zone-name");
  if (field) field.value = Intl.DateTimeFormat().resolvedOptions().timeZone ?? "";
}

document.getElementById("place").addEventListener("input", (event) => {
  typing = event.inputType?.startsWith("insertFromPaste") ? null : event.target;
});
document.addEventListener("htmx:after:swap", () => { moveCross(); offerDevicePlace(); tellDeviceZone(); });
tellDeviceZone();
offerDevicePlace();
