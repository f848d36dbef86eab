// Asks before a view with unsaved changes is left.
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import { guardLeaving } from "../app/router";

export interface Unsaved {
  /** How to leave, where somebody wants to and is to be asked. */
  asked: (() => void) | null;
  /** Leave without asking. */
  allow(leave: () => void): void;
  stay(): void;
}

export function useUnsaved(changed: boolean): Unsaved {
  const [asked, setAsked] = useState<(() => void) | null>(null);
  const lift = useRef<() => void>(() => undefined);
  useLayoutEffect(() => {
    if (!changed) return;
    const stopGuard = guardLeaving((leave) => setAsked(() => leave));
    const warn = (event: BeforeUnloadEvent) => event.preventDefault();
    addEventListener("beforeunload", warn);
    lift.current = () => {
      stopGuard();
      removeEventListener("beforeunload", warn);
    };
    return () => lift.current();
  }, [changed]);
  const allow = (leave: () => void) => {
    lift.current();
    leave();
  };
  return { asked, allow, stay: () => setAsked(null) };
}
