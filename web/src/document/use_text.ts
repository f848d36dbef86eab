// The text that is edited: what it is, what it was, and how it goes back.
import { useRef, useState } from "preact/hooks";
import { begunWith, changed, endOfDifference, goneOn, redone, type TextHistory, undone } from "./text_history";
import type { Caret } from "./text_editor";

export interface EditedText {
  text: string;
  /** Whether it is being typed in. */
  typing: boolean;
  canUndo: boolean;
  canRedo: boolean;
  caret: Caret | null;
  type(text: string): void;
  /** Change it by one of several keys that go back together. */
  move(text: string): void;
  /** Change it in one step, as an action in a drawing does. */
  change(text: string): void;
  undo(): void;
  redo(): void;
}

/** `onText` hears of every text after the first. */
export function useText(first: string, onText: (text: string, before: string) => void): EditedText {
  const [history, setHistory] = useState<TextHistory>(() => begunWith(first));
  const [caret, setCaret] = useState<Caret | null>(null);
  // Two keys may come before the first is drawn.
  const now = useRef(history);
  const become = (next: TextHistory, moved: boolean) => {
    const before = now.current.text;
    if (next === now.current) return;
    now.current = next;
    setHistory(next);
    if (moved) setCaret({ offset: endOfDifference(next.text, before) });
    onText(next.text, before);
  };
  return {
    text: history.text,
    typing: history.going?.by === "typing",
    canUndo: history.past.length > 0,
    canRedo: history.future.length > 0,
    caret,
    type: (text) => become(goneOn(now.current, text, "typing", performance.now()), false),
    move: (text) => become(goneOn(now.current, text, "moving", performance.now()), false),
    change: (text) => become(changed(now.current, text), false),
    undo: () => become(undone(now.current), true),
    redo: () => become(redone(now.current), true),
  };
}
