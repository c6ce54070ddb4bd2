// The seconds that are left to confirm a change of the network.

const box = document.querySelector("[data-network-seconds]");
const until = performance.now() + Number(box.dataset.networkSeconds) * 1000;

function paint() {
  const left = Math.max(0, Math.ceil((until - performance.now()) / 1000));
  for (const place of box.querySelectorAll("[data-network-left]")) place.textContent = `${left} s`;
  for (const words of box.querySelectorAll("[data-network-over]")) words.hidden = left > 0;
  if (left === 0) clearInterval(timer);
}

const timer = setInterval(paint, 250);
