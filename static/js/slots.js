// The actions in the frame's slots: one that cannot work says why beside it when it is pressed, until something else is.

function told(form) {
  for (const other of document.querySelectorAll("[data-told]")) if (other !== form) delete other.dataset.told;
  if (form) form.dataset.told = "";
}

// A press on a button that is off reaches its form.
export function start() {
  if (!document.querySelector(".slot")) return;
  addEventListener("pointerdown", ({ target }) => {
    const form = target.closest?.(".slot .action");
    told(form?.querySelector("button:disabled") ? form : null);
    if (target.closest?.(".outcome")) return;
    for (const outcome of document.querySelectorAll(".slot .outcome")) if (!form?.contains(outcome)) outcome.replaceChildren();
  });
}
