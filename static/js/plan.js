// The plan of a show: what was worked out for other values than those typed now cannot be started.

const form = document.getElementById("plan-form");

const verdict = () => document.getElementById("verdict");

function outdate() {
  verdict().inert = true;
  verdict().setAttribute("aria-busy", "true");
}

form.addEventListener("input", outdate);
form.addEventListener("change", outdate);
document.addEventListener("htmx:finally:request", (event) => {
  if (event.detail?.ctx?.sourceElement !== form || event.detail.ctx.response?.status) return;
  verdict().querySelector("h2").textContent = "No answer: press Check when the connection is back.";
});
