// The key that prints, where there is JavaScript; without it the browser's own menu does.

const key = document.querySelector("[data-print]");
key.hidden = false;
key.addEventListener("click", () => print());
