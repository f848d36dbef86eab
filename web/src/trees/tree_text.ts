// What the console itself knows of a task file's text: its name, and what a new one looks like.

const NAME = /^(?:name|"name")[ \t]*:[ \t]*(["']?)([A-Za-z][\w-]{0,63})\1[ \t]*(?=\r?$|#|,)/m;
const ALLOWED = /[^\w-]+/g;
const LONGEST_NAME = 64;

export const NEW_TREE = `name: my_tree
description: What is to be done, in a sentence.
scene: eket
tree:
  then:
    - {behavior: pick_and_place, object: green_leg, place: green_leg}
    - and:
        - {behavior: pick_and_place, object: pink_bar, place: pink_bar}
        - {behavior: pick_and_place, object: yellow_bar, place: yellow_bar}
`;

/** The name that a task file gives itself, if it is easily found. */
export function nameIn(text: string): string | null {
  return NAME.exec(text)?.[2] ?? null;
}

/** The text with another name. */
export function renamed(text: string, name: string): string {
  return text.replace(NAME, (line, _quote, old: string) => line.replace(old, name));
}

/** A name like `name` that is not yet taken. */
export function freeName(name: string, taken: ReadonlySet<string>): string {
  const stem = name.slice(0, LONGEST_NAME - "_copy_99".length);
  for (let number = 1; ; number++) {
    const tried = number === 1 ? `${stem}_copy` : `${stem}_copy_${number}`;
    if (!taken.has(tried)) return tried;
  }
}

/** A name for a file that gives none: the file's own, as far as a tree may be called so. */
export function nameOfFile(file: string): string {
  const stem = file.replace(/\.[^.]*$/, "").replace(ALLOWED, "_").replace(/^[^A-Za-z]+/, "");
  return stem.slice(0, LONGEST_NAME) || "my_tree";
}
