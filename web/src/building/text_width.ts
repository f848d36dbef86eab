// How wide names are when they are drawn.
const FONT_PX = 12;
const USUAL_SHARE = 0.6;

let context: CanvasRenderingContext2D | null = null;
const widths = new Map<string, number>();

/** In pixels, of a text in the plan's font. */
export function textWidth(text: string, weight = 400): number {
  const key = `${weight}${text}`;
  const known = widths.get(key);
  if (known !== undefined) return known;
  context ??= document.createElement("canvas").getContext("2d");
  if (context === null) return text.length * FONT_PX * USUAL_SHARE;
  context.font = `${weight} ${FONT_PX}px ${getComputedStyle(document.body).fontFamily}`;
  const width = Math.ceil(context.measureText(text).width) + 1;
  widths.set(key, width);
  return width;
}
