// The design's colours, as the 3-D scene needs them.
import { Color } from "three";

export interface Palette {
  readonly ground: Color;
  readonly grid: Color;
  readonly table: Color;
  readonly outline: Color;
  readonly accent: Color;
}

/** Read the tokens as they stand in the theme of an element. */
export function readPalette(element: HTMLElement): Palette {
  const probe = document.createElement("span");
  probe.hidden = true;
  element.append(probe);
  // A token itself reads as it is written, `light-dark(...)`; a property that uses it reads as its colour.
  const token = (name: string) => {
    probe.style.color = `var(${name})`;
    return new Color(getComputedStyle(probe).color);
  };
  const palette = {
    ground: token("--scene-ground"),
    grid: token("--scene-grid"),
    table: token("--scene-table"),
    outline: token("--scene-outline"),
    accent: token("--accent"),
  };
  probe.remove();
  return palette;
}
