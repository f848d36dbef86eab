// What is in the way of something else in a page: pairs of texts, signs and controls that share a
// spot, and what something is drawn over. A sentence for each; a page that is right has none.
() => {
  // Line boxes are a little higher than what is drawn in them.
  const TOLERANCE_PX = 4;
  const CONTROLS = "button, a[href], input, select, textarea, summary, [role=button], [role=slider]";
  const SIGNS = "svg .sign";
  // A label over its control, the tint under a text that is edited, and an answer that is held
  // back over the two answers: each is one thing.
  const WHOLES = "label, .text-editor, .answers";

  const visible = (element) =>
    element.checkVisibility({ opacityProperty: true, visibilityProperty: true, contentVisibilityAuto: true }) &&
    element.closest(".unseen, .skip, [inert]") === null;

  const meet = (a, b) => {
    const [left, top] = [Math.max(a.left, b.left), Math.max(a.top, b.top)];
    const [right, bottom] = [Math.min(a.right, b.right), Math.min(a.bottom, b.bottom)];
    return { left, top, right, bottom };
  };
  const isSeen = ({ left, top, right, bottom }) =>
    right - left > TOLERANCE_PX && bottom - top > TOLERANCE_PX;

  const styles = new Map();
  const styleOf = (element) => {
    let style = styles.get(element);
    if (style === undefined) {
      // What is computed of a live style is computed anew at each look.
      const { position, overflow, pointerEvents } = getComputedStyle(element);
      style = { position, cuts: overflow !== "visible", pointerEvents };
      styles.set(element, style);
    }
    return style;
  };

  /** The part of a box that no ancestor cuts off. */
  const shownPart = (element, box) => {
    let shown = box;
    for (let each = element; each !== null; each = each.parentElement) {
      const { position, cuts } = styleOf(each);
      if (position === "fixed") break;
      if (each !== element && cuts) shown = meet(shown, each.getBoundingClientRect());
    }
    return shown;
  };

  const dialog = document.querySelector("dialog[open]");
  const root = dialog ?? document.body;
  const boxes = [];
  const add = (element, box, words) => {
    const shown = shownPart(element, box);
    if (isSeen(shown)) boxes.push({ element, box: shown, words });
  };
  const texts = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const { currentNode: text } = texts;
    const words = text.data.trim();
    const element = text.parentElement;
    if (words === "" || element.closest("title, option, textarea") !== null || !visible(element)) continue;
    const range = document.createRange();
    range.selectNodeContents(text);
    for (const line of range.getClientRects()) add(element, line, words);
  }
  for (const element of root.querySelectorAll(`${CONTROLS}, ${SIGNS}`)) {
    if (!visible(element) || (element.closest("svg") !== null && !element.matches(SIGNS))) continue;
    const words = element.getAttribute("aria-label") ?? (element.id || element.textContent || element.tagName);
    add(element, element.getBoundingClientRect(), words.trim());
  }

  const nested = (a, b) => a.contains(b) || b.contains(a);
  const together = (a, b) => a.closest(WHOLES) !== null && a.closest(WHOLES) === b.closest(WHOLES);
  const found = [];
  for (const [index, a] of boxes.entries()) {
    for (let other = index + 1; other < boxes.length; other++) {
      const b = boxes[other];
      // Few pairs share a spot, and to see that they do not takes the least.
      const both = meet(a.box, b.box);
      if (!isSeen(both) || nested(a.element, b.element) || together(a.element, b.element)) continue;
      found.push(`“${a.words}” and “${b.words}” share ${Math.round(both.left)}, ${Math.round(both.top)}`);
    }
  }
  for (const { element, box, words } of boxes) {
    // In a drawing a thing's own shape is over its words, to be clicked on.
    if (element.closest("svg") !== null || styleOf(element).pointerEvents === "none") continue;
    const [x, y] = [(box.left + box.right) / 2, (box.top + box.bottom) / 2];
    const top = document.elementFromPoint(x, y);
    if (top === null || nested(top, element) || together(top, element)) continue;
    found.push(`“${words}” is under ${top.tagName}.${top.getAttribute("class")} at ${Math.round(x)}, ${Math.round(y)}`);
  }
  return found;
}
