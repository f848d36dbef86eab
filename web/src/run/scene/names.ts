// The objects' names over the 3-D picture, each at its object; moved with every drawing.
import { type Area, type NameBox, placeNames } from "./name_places";
import type { Spot } from "./scene_view";

export interface Names {
  /** Put to each spot what `shown` says of its name; nothing where that is null. */
  show(spots: readonly Spot[], shown: (name: string) => string | null): void;
}

interface Mark {
  /** At the object's middle. */
  readonly spot: HTMLElement;
  /** The name itself. */
  readonly text: HTMLElement;
  size: { readonly width: number; readonly height: number } | null;
}

/** Names in `host`, which lies over the picture; they keep clear of the elements in `over`. */
export function createNames(host: HTMLElement, over: () => readonly HTMLElement[]): Names {
  const marks = new Map<string, Mark>();
  const markOf = (name: string): Mark => {
    const known = marks.get(name);
    if (known !== undefined) return known;
    const [spot, text] = [document.createElement("span"), document.createElement("span")];
    spot.className = "scene-name";
    spot.append(text);
    host.append(spot);
    const mark: Mark = { spot, text, size: null };
    marks.set(name, mark);
    return mark;
  };
  return {
    show(spots, textOf) {
      const texts = new Map(spots.map(({ name }) => [name, textOf(name)] as const));
      const shown = spots.filter(({ name }) => texts.get(name) !== null);
      for (const [name, { spot }] of marks) spot.hidden = (texts.get(name) ?? null) === null;
      if (shown.length === 0) return;
      // Before anything is moved: else the page would have to be laid out to answer.
      const picture = { left: 0, top: 0, right: host.clientWidth, bottom: host.clientHeight };
      const taken = over().map(areaOf);
      const boxes = shown.map(({ name, x, y, rise, held }): NameBox => {
        const mark = markOf(name);
        const text = texts.get(name) ?? "";
        if (mark.text.textContent !== text) {
          mark.text.textContent = text;
          mark.size = null;
        }
        mark.spot.style.left = `${x.toFixed(1)}px`;
        mark.spot.style.top = `${y.toFixed(1)}px`;
        mark.spot.style.setProperty("--rise", `${rise.toFixed(0)}px`);
        mark.spot.classList.toggle("held", held);
        // Once for a text: to measure it with every drawing would lay out the page each time.
        mark.size ??= { width: mark.text.offsetWidth, height: mark.text.offsetHeight };
        return { name, x, y: y - rise, held, ...mark.size };
      });
      for (const { name, aside, above } of placeNames(boxes, picture, taken)) {
        const { style } = markOf(name).spot;
        style.setProperty("--aside", `${aside.toFixed(0)}px`);
        style.setProperty("--above", `${above.toFixed(0)}px`);
      }
    },
  };
}

function areaOf({ offsetLeft, offsetTop, offsetWidth, offsetHeight }: HTMLElement): Area {
  return { left: offsetLeft, top: offsetTop, right: offsetLeft + offsetWidth, bottom: offsetTop + offsetHeight };
}
