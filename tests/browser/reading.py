"""What a screen reader is told of a page: names, headings, landmarks, and what speaks up by itself."""

from typing import Any

from playwright.sync_api import Page

from tests.browser.layout import LOOKS

CONTROLS = frozenset(
    [
        "button",
        "link",
        "textbox",
        "searchbox",
        "combobox",
        "listbox",
        "checkbox",
        "radio",
        "slider",
        "spinbutton",
        "switch",
        "tab",
        "menuitem",
        "DisclosureTriangle",
    ]
)
LOUD = {
    "outdated-banner": "the page must be loaded again before an order of it counts",
    "link-banner": "values are old and movement keys are off",
    "stopped-words": "the answer to Stop",
    "says-alert": "the machine is in danger, or is about to move",
    "urgent": "the machine does not do what it must, or is about to move",
    "summary-error": "the answer to a form that was just sent",
    "field-error": "the answer to a form that was just sent",
    "outcome-refused": "the answer to a form that was just sent",
    "verdict": "the answer to a plan that was just asked for",
}
"""What may interrupt a screen reader, by its id or class, and why; everything else waits for a pause."""

TOLD = (LOOKS / "told.js").read_text()
NAMED = (LOOKS / "named.js").read_text()


def tree_faults(page: Page) -> list[str]:
    """Return what of a page a screen reader cannot tell, in words."""
    return nameless(page) + page.evaluate(NAMED) + restless(page)


def nameless(page: Page) -> list[str]:
    """Return the controls and pictures of the browser's tree for screen readers that have no name."""
    session = page.context.new_cdp_session(page)
    nodes: list[dict[str, Any]] = session.send("Accessibility.getFullAXTree")["nodes"]
    session.detach()
    return [
        f"without a name: {role} {node.get('backendDOMNodeId')}"
        for node in nodes
        if not node.get("ignored")
        and (role := node.get("role", {}).get("value")) in CONTROLS | {"image", "img", "meter", "progressbar"}
        and not str(node.get("name", {}).get("value", "")).strip()
    ]


def restless(page: Page) -> list[str]:
    """Return what would speak up without need: loudly without a reason, or with every change of a number."""
    found = []
    for one in page.evaluate(TOLD):
        name = " ".join(one["is"]) or "without id or class"
        if one["loud"] and not set(one["is"]) & set(LOUD):
            found.append(f"interrupts without a reason: {name}")
        found += [f"speaks with every change: {name}: {html}" for html in one["restless"]]
    return found
