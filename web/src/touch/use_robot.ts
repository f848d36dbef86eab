// The robot at whose touch screen somebody stands: at which site, where it is, and what it may be asked.
import { useEffect, useState } from "preact/hooks";
import { fleets } from "../requests/fleets";
import * as rest from "../wire/rest";
import type { AskedRobotView, SiteView } from "../wire/types";
import { whyNotDone } from "../words/said";

const AGAIN_MS = 5_000;

export interface UseRobot {
  /** Null until it is known, or where no site has such a robot. */
  site: SiteView | null;
  robot: AskedRobotView | null;
  failure: string;
}

export function useRobot(name: string): UseRobot {
  const site = fleets.value?.find(({ robots }) => robots.some(({ robot }) => robot === name)) ?? null;
  const id = site?.id ?? null;
  const [robot, setRobot] = useState<AskedRobotView | null>(null);
  const [failure, setFailure] = useState("");
  useEffect(() => {
    if (id === null) return undefined;
    let current = true;
    const read = () =>
      rest.askedRobot(id, name).then(
        (found) => {
          if (!current) return;
          setRobot(found);
          setFailure("");
        },
        (error: Error) => current && setFailure(whyNotDone(error)),
      );
    void read();
    const timer = setInterval(() => void read(), AGAIN_MS);
    return () => {
      current = false;
      clearInterval(timer);
    };
  }, [id, name]);
  return { site, robot, failure };
}
