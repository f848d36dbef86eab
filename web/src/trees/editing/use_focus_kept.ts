// Has the keys go on in a drawing where what had them is gone, as after something was undone.
import { useEffect, useRef } from "preact/hooks";

/** `drawn` changes with the drawing; `goOn` is called where nothing has the keys that the drawing had. */
export function useFocusKept(drawn: unknown, goOn: () => void): { current: HTMLDivElement | null } {
  const drawing = useRef<HTMLDivElement>(null);
  const had = useRef(false);
  useEffect(() => {
    const note = (event: FocusEvent) => {
      had.current = drawing.current?.contains(event.target as Node) ?? false;
    };
    document.addEventListener("focusin", note);
    return () => document.removeEventListener("focusin", note);
  }, []);
  useEffect(() => {
    if (had.current && document.activeElement === document.body) goOn();
  }, [drawn]);
  return drawing;
}
