// What is still English on a page in another language, but for what says so: `lang`, code, and names.
() => {
  const ENGLISH = /\b(the|The|is|are|and|not|it|It|its|you|You|your|Your|this|This|that|with|what|What|robot's|has|have|been|from|none|yes|Yes|no|No|of|by)\b/;
  const NAMES = "[lang=en], code, pre, textarea, kbd, title, script, style, .name-of-its-own, option";
  const found = new Set();
  const heard = (element, text) => {
    if (text && ENGLISH.test(text) && element.closest(NAMES) === null && element.checkVisibility()) found.add(text.trim());
  };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) heard(walker.currentNode.parentElement, walker.currentNode.textContent);
  for (const element of document.querySelectorAll("[aria-label], [title], [alt], [placeholder], [aria-valuetext]")) {
    for (const name of ["aria-label", "title", "alt", "placeholder", "aria-valuetext"]) heard(element, element.getAttribute(name));
  }
  return [...found];
}
