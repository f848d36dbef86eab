// The edges between the columns of a run's page: drawn, or moved by the arrow keys; Enter has them as they were made.
import { t } from "../words/words";
import { runLayout } from "./kept_layout";
import { AS_MADE, type RunLayout, SCENE, sceneDrawnTo, SIDE_PX, sideDrawnTo, withScene, withSide } from "./run_layout";
import "./splitters.css";

const SCENE_STEP = 0.02;
const SIDE_STEP_PX = 20;

export function Splitters() {
  const layout = runLayout.value;
  const side = layout.side ?? SIDE_PX.asMade;
  return (
    <>
      <Splitter
        edge="scene"
        label={t("Width of the scene")}
        value={percent(layout.scene)}
        least={percent(SCENE.least)}
        most={percent(SCENE.most)}
        drawnTo={sceneDrawnTo}
        moved={(steps) => withScene(layout, layout.scene + steps * SCENE_STEP)}
        asMade={{ ...layout, scene: AS_MADE.scene }}
      />
      <Splitter
        edge="side"
        label={t("Width of the column at the side")}
        value={side}
        least={SIDE_PX.least}
        most={SIDE_PX.most}
        drawnTo={sideDrawnTo}
        moved={(steps) => withSide(layout, side - steps * SIDE_STEP_PX)}
        asMade={{ ...layout, side: AS_MADE.side }}
      />
    </>
  );
}

const percent = (part: number) => Math.round(part * 100);

interface SplitterProps {
  edge: "scene" | "side";
  label: string;
  value: number;
  least: number;
  most: number;
  drawnTo: (layout: RunLayout, x: number, width: number) => RunLayout;
  /** So many steps to the right. */
  moved: (steps: number) => RunLayout;
  asMade: RunLayout;
}

function Splitter({ edge, label, value, least, most, drawnTo, moved, asMade }: SplitterProps) {
  const draw = (event: PointerEvent) => {
    const handle = event.currentTarget as HTMLElement;
    const page = handle.parentElement;
    if (page === null || !handle.hasPointerCapture(event.pointerId)) return;
    const { left, width } = page.getBoundingClientRect();
    const { paddingLeft, paddingRight } = getComputedStyle(page);
    const before = parseFloat(paddingLeft);
    runLayout.value = drawnTo(runLayout.value, event.clientX - left - before, width - before - parseFloat(paddingRight));
  };
  const key = (event: KeyboardEvent) => {
    const steps = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (steps === 0 && event.key !== "Enter") return;
    event.preventDefault();
    event.stopPropagation();
    runLayout.value = steps === 0 ? asMade : moved(steps);
  };
  return (
    <div
      class={`splitter ${edge}-edge`}
      role="separator"
      aria-orientation="vertical"
      aria-label={label}
      aria-valuenow={value}
      aria-valuemin={least}
      aria-valuemax={most}
      tabIndex={0}
      title={t("Draw, or use the arrow keys")}
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
      onPointerMove={draw}
      onDblClick={() => (runLayout.value = asMade)}
      onKeyDown={key}
    />
  );
}
