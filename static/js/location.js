// Step 1: what the server reads in the fields is put beside them, what was asked goes with a change, and the device's own place.

import { _ } from "./i18n.js";

let typing = null;
let changes = 0;
let asked = 0;

const field = (name) => document.getElementById(`f-${name}`);

// An answer about what was typed before says nothing of what is typed now.
function follow() {
  const found = document.querySelector("#preview .preview[data-zone]");
  if (!found || asked !== changes) return;
  press("latitude", found.dataset.latitudeSide);
  press("longitude", found.dataset.longitudeSide);
  divide(found.dataset);
  const byPlace = field("time_zone").querySelector('option[value=""]');
  if (byPlace && field("time_zone").value === "") byPlace.textContent = found.dataset.zone;
}

// A pair in one field goes to both, unless that field is still being typed in.
function divide({ latitude, longitude }) {
  if (!latitude || (typing && typing === document.activeElement)) return;
  const texts = Object.entries({ latitude, longitude }).filter(([name, text]) => field(name).value !== text);
  for (const [name, text] of texts) field(name).value = text;
  if (texts.length) field("latitude").dispatchEvent(new Event("input", { bubbles: true }));
}

function put(name, value, sides) {
  field(name).value = Math.abs(value).toFixed(5);
  press(name, value < 0 ? sides[1] : sides[0]);
}

function press(name, side) {
  const key = document.querySelector(`input[name="${name}_side"][value="${side}"]`);
  if (key) key.checked = true;
}

// What was asked, or found wrong, was about other values.
function changed(target) {
  changes += 1;
  typing = target;
  document.querySelector("#place-doubts > .question")?.remove();
  const error = target?.closest(".field")?.querySelector(".field-error");
  if (!error) return;
  error.remove();
  target.removeAttribute("aria-invalid");
}

function renew() {
  document.body.dispatchEvent(new CustomEvent("location-typed"));
}

function take(position, words) {
  const { latitude, longitude, altitude, accuracy } = position.coords;
  changed(null);
  put("latitude", latitude, "NS");
  put("longitude", longitude, "EW");
  if (altitude !== null) field("altitude").value = Math.round(altitude);
  tell(words, _("Location taken, accurate to {metres} m. Check it, then save.", { metres: Math.round(accuracy) }));
  field("latitude").dispatchEvent(new Event("input", { bubbles: true }));
}

const REFUSED = {
  1: _("The browser was not allowed to share its location. Allow location access in the browser, or enter the coordinates."),
  2: _("This device does not know its location now. Enter the coordinates."),
  3: _("This device found no location within 20 s. Try again under the open sky, or enter the coordinates."),
};

function tell(words, text) {
  const line = document.createElement("p");
  line.textContent = text;
  words.replaceChildren(line);
}

function offerDevicePlace() {
  const holder = document.getElementById("device-place");
  if (!holder) return;
  const [key, words] = [holder.querySelector("button"), holder.querySelector(".outcome")];
  if (!window.isSecureContext || !navigator.geolocation) {
    holder.querySelector(".reasons span").textContent = _("This browser shares its location only with pages over HTTPS or on the same computer. Enter the coordinates, or paste them as “41.2867, 36.3300”.");
    return;
  }
  holder.querySelector(".reasons").replaceChildren();
  key.disabled = false;
  key.addEventListener("click", () => {
    tell(words, _("Finding the location …"));
    const before = changes;
    // What was typed meanwhile counts.
    const taken = (found) => (changes === before ? take(found, words) : words.replaceChildren());
    navigator.geolocation.getCurrentPosition(taken, (error) => tell(words, REFUSED[error.code] ?? error.message),
      { enableHighAccuracy: true, timeout: 20000, maximumAge: 0 });
  });
}

function tellDeviceZone() {
  const zone = document.getElementById("device-zone-name");
  if (zone) zone.value = Intl.DateTimeFormat().resolvedOptions().timeZone ?? "";
}

for (const kind of ["input", "change"]) {
  document.addEventListener(kind, (event) => {
    if (!event.target.closest("#step-form")) return;
    changed(event.inputType?.startsWith("insertFromPaste") ? null : event.target);
  });
}
// Without its question, which goes with this press, the map has the entered location alone.
document.addEventListener("click", ({ target }) => { if (target.closest?.("#place-doubts [data-cancel]")) setTimeout(renew); }, true);
document.addEventListener("htmx:before:request", ({ detail }) => { if (detail?.ctx?.sourceElement?.id === "preview") asked = changes; });
document.addEventListener("htmx:after:swap", ({ detail }) => {
  if (detail?.ctx?.sourceElement?.id === "preview") follow();
  tellDeviceZone();
});
tellDeviceZone();
offerDevicePlace();
