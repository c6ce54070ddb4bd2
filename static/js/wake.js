// The screen stays awake in the wizard and where axes are moved by hand, where the browser allows it.

let held = null;

async function hold() {
  if (document.hidden || held || !navigator.wakeLock) return;
  try {
    held = await navigator.wakeLock.request("screen");
    document.documentElement.dataset.awake = "";
    held.addEventListener("release", () => {
      held = null;
      delete document.documentElement.dataset.awake;
    });
  } catch {
    held = null; // a battery that is low, or a browser that does not want to: nothing depends on it
  }
}

export function start() {
  if (!document.getElementById("steps") && !document.querySelector("[data-jog]")) return;
  document.addEventListener("visibilitychange", hold);
  hold();
}
