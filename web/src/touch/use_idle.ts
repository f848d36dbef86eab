// Whoever went away in the middle leaves a beginning to who comes next.
import { useEffect, useRef } from "preact/hooks";

/** Call `back` once nothing has been touched or typed for `afterMs`, as long as `on`. */
export function useIdle(on: boolean, afterMs: number, back: () => void): void {
  const then = useRef(back);
  then.current = back;
  useEffect(() => {
    if (!on) return undefined;
    let timer = 0;
    const begin = () => {
      window.clearTimeout(timer);
      timer = window.setTimeout(() => then.current(), afterMs);
    };
    begin();
    window.addEventListener("pointerdown", begin);
    window.addEventListener("keydown", begin);
    return () => {
      window.clearTimeout(timer);
      window.removeEventListener("pointerdown", begin);
      window.removeEventListener("keydown", begin);
    };
  }, [on, afterMs]);
}
