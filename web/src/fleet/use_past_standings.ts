// Where the robots of a fleet were at a moment of its past, as it was recorded.
import { effect } from "@preact/signals";
import { useEffect, useMemo, useState } from "preact/hooks";
import { createStandings, type Standing } from "../building/standing";
import type { Moment } from "../run/moment";
import { decodeFrames } from "../run/scene/decode";
import { createRecordedPoses } from "../run/scene/recorded_poses";
import * as rest from "../wire/rest";
import { OLD_S } from "./fleet_robots";

const NOWHERE: ReadonlyMap<string, Standing> = new Map();

/** By robot; nothing while the newest is shown. `robots` are those of the fleet, in its order. */
export function usePastStandings(site: string, robots: readonly string[], moment: Moment): ReadonlyMap<string, Standing> {
  const [standings, setStandings] = useState(NOWHERE);
  const recorded = useMemo(
    () =>
      createRecordedPoses(
        async (from, to) => {
          const { bytes, recorded } = await rest.fleetPoses(site, from, to);
          return { frames: decodeFrames(bytes), recorded };
        },
        () => false,
      ),
    [site],
  );
  const names = robots.join("\n");
  useEffect(() => {
    const then = createStandings();
    let wanted = 0;
    const show = async (time: number) => {
      wanted += 1;
      const mine = wanted;
      const frame = await recorded.at(time).catch(() => null);
      if (mine !== wanted) return;
      const found = then.at(frame, { time, silent_s: 0, old_s: OLD_S });
      setStandings(new Map(robots.flatMap((robot, index) => (found[index] ? [[robot, found[index]] as const] : []))));
    };
    const stop = effect(() => {
      const time = moment.newest.value ? null : moment.time.value;
      if (time !== null) void show(time);
      else {
        wanted += 1;
        setStandings(NOWHERE);
      }
    });
    return () => {
      wanted += 1;
      stop();
    };
  }, [recorded, names, moment]);
  return standings;
}
