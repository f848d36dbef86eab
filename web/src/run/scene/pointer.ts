// What a pointer over the 3-D picture points at, and what it chooses.
import type { Pointed, SceneView } from "./scene_view";

// A press that moves farther turns the picture instead.
const CLICK_PX = 5;

interface Heard {
  pointed(what: Pointed | null): void;
  chosen(what: Pointed, at: { x: number; y: number }): void;
}

/** Follow the pointer; returns how to stop. */
export function handlePointer(canvas: HTMLCanvasElement, view: SceneView, heard: Heard): () => void {
  let pressed: { x: number; y: number } | null = null;
  let waiting = 0;
  const under = ({ offsetX: x, offsetY: y }: PointerEvent) => ({ x, y });

  const move = (event: PointerEvent) => {
    if (event.buttons !== 0 || event.pointerType === "touch" || waiting !== 0) return;
    const { x, y } = under(event);
    // Pointers may report far more often than pictures are drawn.
    waiting = requestAnimationFrame(() => {
      waiting = 0;
      const what = view.pointedAt(x, y);
      canvas.classList.toggle("over", what?.kind === "object" || what?.kind === "arm");
      heard.pointed(what);
    });
  };
  const leave = () => heard.pointed(null);
  const down = (event: PointerEvent) => {
    pressed = event.isPrimary && event.button === 0 ? under(event) : null;
  };
  const up = (event: PointerEvent) => {
    if (pressed === null || !event.isPrimary) return;
    const at = under(event);
    const moved = Math.hypot(at.x - pressed.x, at.y - pressed.y);
    pressed = null;
    const what = moved > CLICK_PX ? null : view.pointedAt(at.x, at.y);
    if (what !== null) heard.chosen(what, at);
  };

  canvas.addEventListener("pointermove", move);
  canvas.addEventListener("pointerleave", leave);
  canvas.addEventListener("pointerdown", down);
  canvas.addEventListener("pointerup", up);
  return () => {
    cancelAnimationFrame(waiting);
    canvas.removeEventListener("pointermove", move);
    canvas.removeEventListener("pointerleave", leave);
    canvas.removeEventListener("pointerdown", down);
    canvas.removeEventListener("pointerup", up);
  };
}
