// Colours of parts: linear red, green and blue from 0 to 1 in the file, of the screen in the page.

type Color = readonly number[];

const GREY: Color = [0.5, 0.5, 0.5];

/** As the screen has it, as `#e61919`. */
export function screenColor(color: Color | null): string {
  const channels = (color ?? GREY).map((each) => {
    const linear = Math.min(Math.max(each, 0), 1);
    return Math.round(255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055));
  });
  return `#${channels.map((each) => each.toString(16).padStart(2, "0")).join("")}`;
}

/** As the file has it. */
export function linearColor(screen: string): Color {
  return [1, 3, 5].map((from) => {
    const channel = Number.parseInt(screen.slice(from, from + 2), 16) / 255;
    return channel <= 0.04045 ? channel / 12.92 : ((channel + 0.055) / 1.055) ** 2.4;
  });
}
