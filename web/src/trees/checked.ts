// What the service thinks of a text while it is typed: asked after a pause, and only the last counts.
import { useEffect, useState } from "preact/hooks";
import { connection } from "../state/service";
import * as rest from "../wire/rest";
import type { DocumentCheck } from "../wire/types";

const PAUSE_MS = 300;

export interface Checked {
  /** Of the last text that was checked; null before the first. */
  check: DocumentCheck | null;
  /** The last definition without mistakes, for the drawing. */
  definition: DocumentCheck["definition"];
  /** Whether `check` is of an earlier text. */
  pending: boolean;
  /** Why the text could not be checked; empty if it could. */
  failure: string;
}

export function useChecked(text: string): Checked {
  const [checked, setChecked] = useState<Checked>({ check: null, definition: null, pending: true, failure: "" });
  const connected = connection.value === "connected";
  useEffect(() => {
    const abort = new AbortController();
    setChecked((before) => ({ ...before, pending: true }));
    const timer = window.setTimeout(
      () => {
        rest.checkTree(text, abort.signal).then(
          (check) =>
            setChecked((before) => ({
              check,
              definition: check.definition ?? before.definition,
              pending: false,
              failure: "",
            })),
          (error: Error) => {
            if (abort.signal.aborted) return;
            setChecked((before) => ({ ...before, pending: false, failure: error.message }));
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
