// What the service thinks of a text while it changes: asked after a pause, and only the last counts.
import { useEffect, useState } from "preact/hooks";
import { connection } from "../state/service";
import type { DocumentCheck } from "../wire/types";
import { whyNotDone } from "../words/said";

const PAUSE_MS = 300;

export interface Checked {
  /** Of the last text that was checked; null before the first. */
  check: DocumentCheck | null;
  /** The text that `check` is of. */
  text: string;
  /** The last definition without mistakes, for the drawing. */
  definition: DocumentCheck["definition"];
  /** The worlds that were asked last, for what they say of robots. */
  worlds: DocumentCheck["worlds"];
  /** Whether `check` is of an earlier text. */
  pending: boolean;
  /** Why the text could not be checked; empty if it could. */
  failure: string;
}

const UNCHECKED: Checked = { check: null, text: "", definition: null, worlds: [], pending: true, failure: "" };

/** `ask` has a text checked; it is always the same function. */
export function useChecked(text: string, ask: (text: string, signal: AbortSignal) => Promise<DocumentCheck>): Checked {
  const [checked, setChecked] = useState<Checked>(UNCHECKED);
  const connected = connection.value === "connected";
  useEffect(() => {
    const abort = new AbortController();
    setChecked((before) => ({ ...before, pending: true }));
    const timer = window.setTimeout(
      () => {
        ask(text, abort.signal).then(
          (check) =>
            setChecked((before) => ({
              check,
              text,
              definition: check.definition ?? before.definition,
              worlds: check.worlds.length > 0 ? check.worlds : before.worlds,
              pending: false,
              failure: "",
            })),
          (error: Error) => {
            if (abort.signal.aborted) return;
            setChecked((before) => ({ ...before, pending: false, failure: whyNotDone(error) }));
          },
        );
      },
      checked.check === null ? 0 : PAUSE_MS,
    );
    return () => {
      window.clearTimeout(timer);
      abort.abort();
    };
  }, [text, connected]);
  return checked;
}
