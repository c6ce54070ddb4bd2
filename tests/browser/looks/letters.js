// What an open page writes, by the fonts it asks for: the letters of its text, of its fields, and of what styles put beside.
() => {
  const letters = {};
  const put = (words, style) => {
    for (const letter of words.replace(/\s/g, "")) (letters[style.fontFamily] ??= new Set()).add(letter);
  };
  const fields = "textarea, input:not([type=hidden], [type=checkbox], [type=radio], [type=file], [type=range], [type=color])";
  for (const one of document.body.querySelectorAll("*")) {
    if (!one.checkVisibility() || one.closest("script, style, template, canvas")) continue;
    const style = getComputedStyle(one);
    [...one.childNodes].filter((node) => node.nodeType === Node.TEXT_NODE).forEach((node) => put(node.data, style));
    if (one.matches(fields)) put(one.value + one.placeholder, style);
    if (one.matches("input[type=file]")) put("File", getComputedStyle(one, "::file-selector-button"));
    for (const side of ["::before", "::after"]) {
      const beside = getComputedStyle(one, side);
      if (/^"/.test(beside.content)) put(beside.content.slice(1, -1), beside);
    }
  }
  return Object.fromEntries(Object.entries(letters).map(([fonts, found]) => [fonts, [...found].sort().join("")]));
}
