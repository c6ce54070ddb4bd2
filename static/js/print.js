// The keys that print, where there is JavaScript; without it the browser's own menu does.

const offer = () => {
  for (const key of document.querySelectorAll("[data-print]")) key.hidden = false;
};

document.addEventListener("click", (event) => {
  if (event.target.closest("[data-print]")) print();
});
document.addEventListener("htmx:after:swap", offer);
offer();
