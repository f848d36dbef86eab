// Shift and an arrow go to the fault before or after, wherever the focus is but in a field for text.
import { useEffect } from "preact/hooks";

const DIRECTIONS: Readonly<Record<string, -1 | 1>> = { ArrowLeft: -1, ArrowRight: 1 };

/** Where these keys choose text or another option. */
const OWN_KEYS = "textarea, select, [contenteditable], input:not([type=range], [type=checkbox], [type=radio])";

export function useFaultKeys(go: (direction: -1 | 1) => void): void {
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      const direction = DIRECTIONS[event.key];
      if (direction === undefined || !event.shiftKey || event.ctrlKey || event.altKey || event.metaKey) return;
      if (event.target instanceof Element && event.target.closest(OWN_KEYS) !== null) return;
      // Text that is chosen with the keys goes on being chosen.
      if (getSelection()?.isCollapsed === false) return;
      event.preventDefault();
      event.stopPropagation();
      go(direction);
    };
    addEventListener("keydown", press, { capture: true });
    return () => removeEventListener("keydown", press, { capture: true });
  }, [go]);
}
