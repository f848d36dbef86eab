// What a text says, read anew whenever it changes: a long one that is typed in after a pause.
import { useEffect, useMemo, useState } from "preact/hooks";
import type { EditedText } from "./use_text";

const LONG = 8 * 1024;
const PAUSE_MS = 200;

export interface Reading<T> {
  /** The text that was read. */
  text: string;
  says: T;
}

/** `read` is always the same function. */
export function useRead<T>({ text, typing }: EditedText, read: (text: string) => T): Reading<T> {
  const waits = typing && text.length > LONG;
  const [settled, settle] = useState(text);
  useEffect(() => {
    if (settled === text) return;
    const timer = window.setTimeout(() => settle(text), waits ? PAUSE_MS : 0);
    return () => window.clearTimeout(timer);
  }, [text, waits]);
  const wanted = waits ? settled : text;
  return useMemo(() => ({ text: wanted, says: read(wanted) }), [wanted]);
}
