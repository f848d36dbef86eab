// The keys that answer: single letters that a helper can change or switch off, and the ways by number.
import { useLayoutEffect } from "preact/hooks";
import { keys, keysOn } from "../state/preferences";
import { type Question } from "../state/questions";
import { type Answer, undo } from "./answering";
import { repeat } from "./repeating";

// Where a letter is typed, or something else than the question is to be decided.
const ELSEWHERE = "input, textarea, select, [contenteditable], dialog";

export type KeyAction = "yes" | "no" | "repeat" | "undo" | { way: number };

/** What a pressed key does; Escape takes back an answer even where the letters are off. */
export function actionOf(
  pressed: Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "altKey" | "repeat">,
  set: { yes: string; no: string; repeat: string },
  on: boolean,
): KeyAction | null {
  if (pressed.ctrlKey || pressed.metaKey || pressed.altKey || pressed.repeat) return null;
  if (pressed.key === "Escape") return "undo";
  const key = pressed.key.toLowerCase();
  if (!on) return null;
  if (key === set.yes) return "yes";
  if (key === set.no) return "no";
  if (key === set.repeat) return "repeat";
  return /^[1-9]$/.test(key) ? { way: Number(key) } : null;
}

/** Let the keys answer this question while its card is shown. */
export function useAnswerKeys(
  question: Question,
  onAnswer: (value: Answer) => void,
  onChoose: (way: string) => void,
): void {
  // With the drawing, not after it: a key that is pressed as soon as the card is seen must find it.
  useLayoutEffect(() => {
    const pressed = (event: KeyboardEvent) => {
      const target = event.target as Element;
      const isRange = target instanceof HTMLInputElement && target.type === "range";
      if (event.defaultPrevented || (target.closest(ELSEWHERE) !== null && !isRange)) return;
      const action = actionOf(event, keys.value, keysOn.value);
      if (action === "undo") undo();
      else if (action === "repeat") repeat(question);
      else if (action === "yes" || action === "no") onAnswer(action);
      else if (action !== null) {
        const chosen = question.prompt?.ways[action.way - 1];
        if (chosen !== undefined) onChoose(chosen.way);
      }
    };
    window.addEventListener("keydown", pressed);
    return () => window.removeEventListener("keydown", pressed);
  });
}
