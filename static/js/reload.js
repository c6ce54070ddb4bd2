// Loads a page again by asking for it: a reload would send once more the form that the page is the answer to.

export const loadAgain = () => location.replace(location.pathname + location.search);
