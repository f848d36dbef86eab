// Which connected robots a live run may have, and which of the scene's robots each of them is.
import * as rest from "../../wire/rest";
import type { RobotView, RunRequest } from "../../wire/types";

/** The robots that a task tree's own scene names, in its order; none where it names none. */
export async function placesOf(tree: string): Promise<readonly string[]> {
  const scene = (await rest.tree(tree)).definition.scene;
  if (typeof scene !== "string") return [];
  return Object.keys((await rest.scene(scene)).definition.robots ?? {});
}

/** Those that can be chosen: connected, and none that the service runs itself. */
export const connectedOnes = (robots: readonly RobotView[]) =>
  robots.filter(({ connected, simulated }) => connected && !simulated);

/** What a request says of the robots: by place where the scene has places, else a list. */
export function robotsOfRequest(
  chosen: readonly string[],
  standing: Readonly<Record<string, string>>,
  places: readonly string[],
): NonNullable<RunRequest["robots"]> {
  if (places.length === 0) return [...chosen];
  return Object.fromEntries(
    places.flatMap((place) => {
      const robot = standing[place] ?? "";
      return robot === "" ? [] : [[place, robot]];
    }),
  );
}
