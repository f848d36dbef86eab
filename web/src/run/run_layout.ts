// How wide the parts of a run's page are, as somebody draws them.
export interface RunLayout {
  /** The scene's part of the width that it shares with the tree. */
  readonly scene: number;
  /** Of the column at the side, in px; null as long as nobody has changed it. */
  readonly side: number | null;
}

export const AS_MADE: RunLayout = { scene: 0.5, side: null };

export const SCENE = { least: 0.25, most: 0.75 } as const;
export const SIDE_PX = { least: 280, most: 800, asMade: 400 } as const;

/** Between two columns; as in `run.css`. */
const GAP_PX = 12;

const within = (value: number, { least, most }: { least: number; most: number }) => Math.min(most, Math.max(least, value));

export function withScene(layout: RunLayout, scene: number): RunLayout {
  return { ...layout, scene: within(scene, SCENE) };
}

export function withSide(layout: RunLayout, side: number): RunLayout {
  return { ...layout, side: within(side, SIDE_PX) };
}

/** Where the edge between scene and tree was drawn to: `x` px from the left of a page so wide. */
export function sceneDrawnTo(layout: RunLayout, x: number, width: number): RunLayout {
  const shared = width - (layout.side ?? SIDE_PX.asMade) - 2 * GAP_PX;
  return withScene(layout, (x - GAP_PX / 2) / shared);
}

/** Where the edge of the side's column was drawn to. */
export function sideDrawnTo(layout: RunLayout, x: number, width: number): RunLayout {
  return withSide(layout, width - x - GAP_PX / 2);
}

/** What the style sheet reads. */
export function styleOf({ scene, side }: RunLayout): Record<string, string> {
  return {
    "--scene-width": `${scene}fr`,
    "--tree-width": `${1 - scene}fr`,
    ...(side === null ? {} : { "--side-width": `${side}px` }),
  };
}
