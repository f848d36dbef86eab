// The objects' names over the 3-D picture, each in its object's middle; moved with every drawing.
import { plain } from "./interventions";
import type { Spot } from "./scene_view";

export interface Names {
  /** Put names to those spots for which `wanted` is true. */
  show(spots: readonly Spot[], wanted: (name: string) => boolean): void;
}

export function createNames(host: HTMLElement): Names {
  const marks = new Map<string, HTMLElement>();
  const markOf = (name: string) => {
    const known = marks.get(name);
    if (known !== undefined) return known;
    const mark = document.createElement("span");
    mark.className = "scene-name";
    const text = document.createElement("span");
    text.textContent = plain(name);
    mark.append(text);
    host.append(mark);
    marks.set(name, mark);
    return mark;
  };
  return {
    show(spots, wanted) {
      const shown = new Set<string>();
      for (const { name, x, y, rise, held } of spots) {
        if (!wanted(name)) continue;
        const { style, classList } = markOf(name);
        style.translate = `${x.toFixed(1)}px ${y.toFixed(1)}px`;
        style.setProperty("--rise", `${rise.toFixed(0)}px`);
        classList.toggle("held", held);
        shown.add(name);
      }
      for (const [name, mark] of marks) mark.hidden = !shown.has(name);
    },
  };
}
