// The demo: a simulated robot that is robbed and asks whoever is signed in.
import type { RobotView, RunRequest, RunSummary } from "../wire/types";

/** A simulated person does what is promised, so that the first answer already comes true. */
export const DEMO: RunRequest = {
  tree: "eket",
  world: "tabletop",
  scenario: "eket_paper",
  answers: "live",
  speed: 2,
};

interface There {
  readonly runs: Iterable<RunSummary>;
  readonly robots: readonly RobotView[];
  /** How many buildings have robots that take requests. */
  readonly fleets: number;
}

/** Only where nothing goes on, and no robot is anybody's own: nobody at work wants to see it. */
export function offersDemo({ runs, robots, fleets }: There): boolean {
  const goesOn = [...runs].some(({ status }) => status === "running" || status === "paused");
  return !goesOn && fleets === 0 && robots.every(({ simulated }) => simulated);
}
