// A pointer that drags something, until it lets go.

const BEGINS_PX = 3;

export type Dragging = Pick<PointerEvent, "clientX" | "clientY" | "shiftKey">;

/** Follow a pointer; `end` hears where it let go, and null where it hardly moved or gave up. */
export function follow(begun: PointerEvent, onWay: (at: Dragging) => void, end: (at: Dragging | null) => void): void {
  let begins = false;
  const ended = new AbortController();
  const { signal } = ended;
  const finish = (at: Dragging | null) => {
    ended.abort();
    end(at);
  };
  addEventListener("pointermove", (event) => {
    begins ||= Math.hypot(event.clientX - begun.clientX, event.clientY - begun.clientY) >= BEGINS_PX;
    if (begins) onWay(event);
  }, { signal });
  addEventListener("pointerup", (event) => finish(begins ? event : null), { signal });
  addEventListener("pointercancel", () => finish(null), { signal });
  addEventListener("keydown", (event) => event.key === "Escape" && finish(null), { signal });
}
