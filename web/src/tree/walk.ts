// Going through a tree with the keys.
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import type { TreeLayout } from "./layout";
import { parentOf } from "./tree_node";

/** A node to go to. */
export interface GoTo {
  path: string;
}

/** One node can be reached with Tab; the arrow keys go on from it as in any tree. */
export function useWalk(
  layout: TreeLayout,
  initial: string | null,
  toggle: (path: string) => void,
  onSelect: ((path: string) => void) | undefined,
  goTo: GoTo | null = null,
) {
  const [walked, setWalked] = useState<string | null>(null);
  const elements = useRef(new Map<string, SVGGElement>());
  const goingTo = useRef<string | null>(null);
  const shown = (path: string | null) => layout.nodes.some((placed) => placed.node.path === path);
  const at = shown(walked) ? walked : shown(initial) ? initial : (layout.nodes[0]?.node.path ?? null);
  useLayoutEffect(() => {
    if (at === null || goingTo.current !== at) return;
    goingTo.current = null;
    elements.current.get(at)?.focus();
  }, [at]);
  useLayoutEffect(() => {
    if (goTo === null) return;
    setWalked(goTo.path);
    elements.current.get(goTo.path)?.focus();
  }, [goTo]);
  const go = (path: string | undefined | null) => {
    if (path === undefined || path === null) return;
    goingTo.current = path;
    setWalked(path);
  };
  const take = (path: string) => {
    setWalked(path);
    onSelect?.(path);
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const focused = (event.target as Element).getAttribute("data-path");
    const index = layout.nodes.findIndex((placed) => placed.node.path === focused);
    const placed = layout.nodes[index];
    if (placed === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    const { path } = placed.node;
    const steps: Record<string, () => void> = {
      ArrowDown: () => go(layout.nodes[index + 1]?.node.path),
      ArrowUp: () => go(layout.nodes[index - 1]?.node.path),
      ArrowRight: () => (placed.hidden > 0 ? toggle(path) : placed.expandable && go(layout.nodes[index + 1]?.node.path)),
      ArrowLeft: () => (placed.expandable && placed.hidden === 0 && index > 0 ? toggle(path) : go(parentOf(path))),
      Home: () => go(layout.nodes[0]?.node.path),
      End: () => go(layout.nodes.at(-1)?.node.path),
      Enter: () => take(path),
      " ": () => take(path),
    };
    const step = steps[event.key];
    if (step === undefined) return;
    event.preventDefault();
    step();
  };
  const refOf = (path: string) => (element: SVGGElement | null) => {
    if (element === null) elements.current.delete(path);
    else elements.current.set(path, element);
  };
  return { at, take, onKeyDown, refOf };
}
