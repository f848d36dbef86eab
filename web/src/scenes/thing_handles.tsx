// What the selected thing is turned and made larger by: a knob before its front, and one at its corner.
import type { Thing } from "./scene_source";
import { placed, type ViewFrame } from "./view_frame";
import { t } from "../words/words";

const BEFORE_PX = 26;
const KNOB_PX = 6;
/** As large as a finger needs it. */
const HAND_PX = 12;

interface ThingHandlesProps {
  thing: Thing;
  frame: ViewFrame;
  onTurn: (event: PointerEvent) => void;
  onResize: (event: PointerEvent) => void;
}

export function ThingHandles({ thing, frame, onTurn, onResize }: ThingHandlesProps) {
  const { kind, pose, size } = thing;
  const [high, wide] = kind === "robot" ? [36, 28] : [(size?.[0] ?? 0.05) * frame.scale, (size?.[1] ?? 0.05) * frame.scale];
  const front = -high / 2 - BEFORE_PX;
  return (
    <g class="handles" transform={placed(frame, pose)} aria-hidden="true">
      <path class="stalk" d={`M0 ${-high / 2}V${front + KNOB_PX}`} />
      <g class="handle turn" onPointerDown={onTurn}>
        <title>{t("Turn it")}</title>
        <circle class="hand" cy={front} r={HAND_PX} />
        <circle class="knob" cy={front} r={KNOB_PX} />
      </g>
      {/* At the other corner is the sign of what is wrong. */}
      {kind === "object" && (
        <g class="handle resize" onPointerDown={onResize}>
          <title>{t("Make it larger or smaller")}</title>
          <circle class="hand" cx={-wide / 2 - KNOB_PX} cy={-high / 2 - KNOB_PX} r={HAND_PX} />
          <rect class="knob" x={-wide / 2 - 2 * KNOB_PX} y={-high / 2 - 2 * KNOB_PX} width={2 * KNOB_PX} height={2 * KNOB_PX} />
        </g>
      )}
    </g>
  );
}
