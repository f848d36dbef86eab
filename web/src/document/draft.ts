// Texts of task trees and scenes that are not saved yet: kept on this device until they are, so that neither a
// mistake nor a closed page, an ended session or a lost connection takes one.

export interface Draft {
  text: string;
  name: string;
  /** What to say of it when it is opened, such as where it came from. */
  note: string;
}

const inMemory = new Map<string, Draft>();

/** The draft of a tree (null: of a new one), if there is one; of a scene with `scene:` before its name. */
export function keptDraft(tree: string | null): Draft | null {
  const key = keyOf(tree);
  const held = inMemory.get(key);
  if (held !== undefined) return held;
  const stored = localStorage.getItem(key);
  return stored === null ? null : (JSON.parse(stored) as Draft);
}

export function keepDraft(tree: string | null, draft: Draft): void {
  const key = keyOf(tree);
  inMemory.set(key, draft);
  try {
    localStorage.setItem(key, JSON.stringify(draft));
  } catch {
    // There is no more room on this device: it is kept as long as this page is.
    localStorage.removeItem(key);
  }
}

export function dropDraft(tree: string | null): void {
  inMemory.delete(keyOf(tree));
  localStorage.removeItem(keyOf(tree));
}

const keyOf = (tree: string | null) => `mend.draft.${tree ?? ""}`;
