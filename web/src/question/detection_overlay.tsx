// What the robot detected, drawn on its picture: where the part must be and where it was seen.
import type { Detection } from "../wire/types";
import { t } from "../words/words";

interface Size {
  width: number;
  height: number;
}

interface Point {
  x: number;
  y: number;
}

/** The shapes of a detection in the pixels of a picture of `size`; null where it has no place. */
export interface Shapes {
  expected: (Point & { half: number }) | null;
  seen: (Point & { radius: number }) | null;
}

/** A detection counts the camera's pixels; the picture may be an enlarged one. */
export function shapesOf(detection: Detection, size: Size): Shapes | null {
  if (detection.size_px === null) return null;
  const scale = size.width / Number(detection.size_px[0]);
  const point = ([u, v]: readonly [unknown, unknown]) => ({
    x: (Number(u) + 0.5) * scale,
    y: (Number(v) + 0.5) * scale,
  });
  const { center, expected } = detection;
  if (center === null && expected === null) return null;
  return {
    expected: expected === null ? null : { ...point(expected), half: (detection.tolerance_px ?? 4) * scale },
    seen:
      center === null
        ? null
        : { ...point(center), radius: Math.max(3, Math.sqrt(detection.area_px / Math.PI)) * scale },
  };
}

export function DetectionOverlay({ detection, size }: { detection: Detection; size: Size }) {
  const shapes = shapesOf(detection, size);
  if (shapes === null) return null;
  const { expected, seen } = shapes;
  const text = size.width / 22;
  return (
    <svg class="overlay" viewBox={`0 0 ${size.width} ${size.height}`} aria-hidden="true">
      {expected !== null && (
        <g class="expected">
          <rect
            x={expected.x - expected.half}
            y={expected.y - expected.half}
            width={2 * expected.half}
            height={2 * expected.half}
            rx={text / 4}
          />
          <Label {...above(expected, expected.half, size, text)} size={text} text={t("should be here")} />
        </g>
      )}
      {seen !== null && (
        <g class="seen">
          <circle cx={seen.x} cy={seen.y} r={seen.radius} />
          <path d={`M${seen.x - text / 2} ${seen.y}h${text}M${seen.x} ${seen.y - text / 2}v${text}`} />
          <Label {...below(seen, seen.radius, size, text)} size={text} text={t("seen here")} />
        </g>
      )}
    </svg>
  );
}

function Label({ x, y, size, text }: Point & { size: number; text: string }) {
  return (
    <text x={x} y={y} font-size={size} text-anchor="middle">
      {text}
    </text>
  );
}

// Labels stay inside the picture, whatever is near its edge.
function above(at: Point, reach: number, size: Size, text: number): Point {
  return { x: inside(at.x, 4 * text, size.width), y: Math.max(1.2 * text, at.y - reach - text / 2) };
}

function below(at: Point, reach: number, size: Size, text: number): Point {
  const y = at.y + Math.max(reach, text / 2) + 1.2 * text;
  return { x: inside(at.x, 3 * text, size.width), y: Math.min(size.height - text / 2, y) };
}

function inside(value: number, margin: number, length: number): number {
  return Math.min(Math.max(value, margin), length - margin);
}
