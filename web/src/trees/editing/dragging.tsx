// Dragging nodes of a drawn tree with the pointer: where one would go is shown, and said.
import { useEffect, useRef, useState } from "preact/hooks";
import type { TreeLayout } from "../../tree/layout";
import { dropAt, markOf } from "./drop_position";
import type { Drop } from "./moves";

const BEGINS_PX = 6;

interface DraggingProps {
  layout: TreeLayout;
  /** Whether a node may be dropped there. */
  allowed: (path: string, drop: Drop) => boolean;
  onOver: (path: string, drop: Drop | null) => void;
  onDrop: (path: string, drop: Drop) => void;
}

interface Drag {
  path: string;
  x: number;
  y: number;
  drop: Drop | null;
}

export function Dragging(props: DraggingProps) {
  const group = useRef<SVGGElement>(null);
  const [drag, setDrag] = useState<Drag | null>(null);
  const now = useRef(props);
  now.current = props;
  useEffect(() => listen((group.current as SVGGElement).ownerSVGElement as SVGSVGElement, now, setDrag), []);
  const mark = drag?.drop ? markOf(props.layout, drag.drop) : null;
  const dragged = props.layout.nodes.find(({ node }) => node.path === drag?.path);
  return (
    <g ref={group} class="dragging" aria-hidden="true">
      {drag !== null && dragged !== undefined && (
        <rect class="ghost" x={drag.x + 8} y={drag.y + 8} width={dragged.width} height={dragged.height} rx={10} />
      )}
      {mark !== null && <rect class={`drop ${drag?.drop?.where}`} {...mark} rx={drag?.drop?.where === "inside" ? 8 : 2} />}
    </g>
  );
}

/** Touch scrolls the drawing; who has no pointer has buttons and keys for it. */
function listen(svg: SVGSVGElement, now: { current: DraggingProps }, setDrag: (drag: Drag | null) => void): () => void {
  const stopped = new AbortController();
  const { signal } = stopped;
  let grabbed: { path: string; event: PointerEvent } | null = null;
  let drag: Drag | null = null;
  const become = (next: Drag | null) => {
    drag = next;
    setDrag(next);
  };
  const end = () => {
    grabbed = null;
    become(null);
  };
  svg.addEventListener("pointerdown", (event) => {
    const path = (event.target as Element).closest("[data-path]")?.getAttribute("data-path");
    if (event.button === 0 && event.pointerType !== "touch" && path && path !== "/") grabbed = { path, event };
  }, { signal });
  addEventListener("pointermove", (event) => {
    if (grabbed === null) return;
    const moved = Math.hypot(event.clientX - grabbed.event.clientX, event.clientY - grabbed.event.clientY);
    if (drag === null && moved < BEGINS_PX) return;
    const { x, y } = pointIn(svg, event);
    const over = dropAt(now.current.layout, x, y, grabbed.path);
    const drop = over !== null && now.current.allowed(grabbed.path, over) ? over : null;
    if (drag === null || drag.drop?.path !== drop?.path || drag.drop?.where !== drop?.where) now.current.onOver(grabbed.path, drop);
    become({ path: grabbed.path, x, y, drop });
  }, { signal });
  addEventListener("pointerup", () => {
    const done = drag;
    end();
    if (done?.drop) now.current.onDrop(done.path, done.drop);
    else if (done !== null) now.current.onOver(done.path, null);
  }, { signal });
  addEventListener("pointercancel", end, { signal });
  addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || drag === null) return;
    now.current.onOver(drag.path, null);
    end();
  }, { signal });
  return () => stopped.abort();
}

function pointIn(svg: SVGSVGElement, event: PointerEvent): DOMPoint {
  return new DOMPoint(event.clientX, event.clientY).matrixTransform((svg.getScreenCTM() as DOMMatrix).inverse());
}
