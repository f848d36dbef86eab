// The states of a text that can be gone back to, whether it was typed or changed in a drawing.

export interface TextHistory {
  past: readonly string[];
  text: string;
  future: readonly string[];
  /** What was done last that may go on, and when (ms); null where nothing was. */
  going: { by: Going; atMs: number } | null;
}

/** What goes back in one step where it goes on without a pause: typing, and moving with keys. */
export type Going = "typing" | "moving";

const PAUSE_MS = 1000;
const MOST_STATES = 200;
const MOST_CHARACTERS = 16 * 1024 * 1024;

export function begunWith(text: string): TextHistory {
  return { past: [], text, future: [], going: null };
}

export function goneOn(history: TextHistory, text: string, by: Going, atMs: number): TextHistory {
  if (text === history.text) return history;
  const { going } = history;
  const past = going?.by === by && atMs - going.atMs < PAUSE_MS ? history.past : kept(history);
  return { past, text, future: [], going: { by, atMs } };
}

/** A change that is a step of its own. */
export function changed(history: TextHistory, text: string): TextHistory {
  if (text === history.text) return history;
  return { past: kept(history), text, future: [], going: null };
}

export function undone(history: TextHistory): TextHistory {
  const text = history.past.at(-1);
  if (text === undefined) return history;
  return { past: history.past.slice(0, -1), text, future: [history.text, ...history.future], going: null };
}

export function redone(history: TextHistory): TextHistory {
  const [text, ...future] = history.future;
  if (text === undefined) return history;
  return { past: [...history.past, history.text], text, future, going: null };
}

/** The past with the present: as much of it as there is room for, the oldest goes first. */
function kept({ past, text }: TextHistory): string[] {
  const states = [...past, text].slice(-MOST_STATES);
  let characters = states.reduce((sum, each) => sum + each.length, 0);
  while (characters > MOST_CHARACTERS && states.length > 1) characters -= (states.shift() as string).length;
  return states;
}

/** Where the part of a text ends that another one says differently. */
export function endOfDifference(text: string, other: string): number {
  const most = Math.min(text.length, other.length);
  let begin = 0;
  while (begin < most && text[begin] === other[begin]) begin++;
  let end = 0;
  while (end < most - begin && text[text.length - 1 - end] === other[other.length - 1 - end]) end++;
  return text.length - end;
}
