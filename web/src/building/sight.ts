// Which part of a floor is seen, and how large: moved, zoomed and fitted, never lost from view.
import type { Box } from "./plan";

export interface Size {
  readonly width: number;
  readonly height: number;
}

/** A point (x, y) of the plan is drawn at (left + x * scale, top - y * scale), in pixels. */
export interface Sight {
  /** Pixels per metre. */
  readonly scale: number;
  readonly left: number;
  readonly top: number;
}

const MARGIN_PX = 28;
const MOST_PX_PER_M = 160;
/** So much of the whole is seen when it is farthest away. */
const FARTHEST = 0.6;
/** Of the plan so much stays in view, however far it is moved. */
const KEPT_PX = 48;

/** All of a box in the middle of what can be seen. */
export function fitted(box: Box, size: Size): Sight {
  const scale = fittingScale(box, size);
  return centred({ x: (box.left + box.right) / 2, y: (box.bottom + box.top) / 2 }, scale, size);
}

function fittingScale(box: Box, { width, height }: Size): number {
  const across = Math.max(width - 2 * MARGIN_PX, 1) / Math.max(box.right - box.left, 1);
  const up = Math.max(height - 2 * MARGIN_PX, 1) / Math.max(box.top - box.bottom, 1);
  return Math.min(across, up, MOST_PX_PER_M);
}

/** A point of the plan in the middle. */
export function centred({ x, y }: { x: number; y: number }, scale: number, size: Size): Sight {
  return { scale, left: size.width / 2 - x * scale, top: size.height / 2 + y * scale };
}

/** Nearer (a factor above 1) or farther; what is at a pixel stays there. */
export function zoomed(sight: Sight, factor: number, at: { x: number; y: number }, box: Box, size: Size): Sight {
  const fitting = fittingScale(box, size);
  const scale = Math.min(Math.max(sight.scale * factor, fitting * FARTHEST), MOST_PX_PER_M);
  const grown = scale / sight.scale;
  return kept({ scale, left: at.x - (at.x - sight.left) * grown, top: at.y - (at.y - sight.top) * grown }, box, size);
}

export function moved(sight: Sight, dx: number, dy: number, box: Box, size: Size): Sight {
  return kept({ ...sight, left: sight.left + dx, top: sight.top + dy }, box, size);
}

/** Some of the plan is always there to be seen. */
function kept({ scale, left, top }: Sight, box: Box, { width, height }: Size): Sight {
  const within = (value: number, low: number, high: number) => Math.min(Math.max(value, low), high);
  return {
    scale,
    left: within(left, KEPT_PX - box.right * scale, width - KEPT_PX - box.left * scale),
    top: within(top, KEPT_PX + box.bottom * scale, height - KEPT_PX + box.top * scale),
  };
}

export function drawnAt({ scale, left, top }: Sight, x: number, y: number): { x: number; y: number } {
  return { x: left + x * scale, y: top - y * scale };
}
