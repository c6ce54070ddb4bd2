// What the server told this page that scripts need to know: app/web/shell/page_facts.py writes it, so it is said once.

export const facts = JSON.parse(document.getElementById("facts").textContent);
