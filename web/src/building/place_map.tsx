// Where in its building a robot is that asks: the floor, a small map around it, and a sentence.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { robotName } from "../question/fault_words";
import type { Frame } from "../run/scene/decode";
import { watchRun, type WatchState } from "../run/scene/live_poses";
import { helperName } from "../state/preferences";
import * as rest from "../wire/rest";
import { FloorDrawing } from "./floor_drawing";
import { namesHidden, PlaceNames, useNames } from "./place_names";
import { type Plan, planOf } from "./plan";
import { RADIUS_M } from "./robot_marks";
import { centred, drawnAt } from "./sight";
import { createStandings, howLong, OLD_S, type Standing } from "./standing";
import { useSize } from "./use_sight";
import { floorShownAt, nearestPlace, whereInWords } from "./whereabouts";
import { parts, t } from "../words/words";
import "./building.css";

const LOOK_MS = 500;
const LEAST_ACROSS_M = 12;
const LEAST_RADIUS_PX = 10;
/** Where the floor's name stands. */
const FLOOR_SIGN = { left: 0, top: 0, right: 96, bottom: 36 };

export function PlaceMap({ run, robot }: { run: string; robot: string }) {
  const plan = usePlan(run);
  const standing = useStanding(run, robot);
  if (plan === null) return null;
  if (standing === null) return <p class="small quiet">{t("{robot} has not said where it is.", { robot: robotName(robot) })}</p>;
  return <Map plan={plan} standing={standing} name={robotName(robot)} />;
}

function Map({ plan, standing, name }: { plan: Plan; standing: Standing; name: string }) {
  const view = useRef<HTMLDivElement>(null);
  const size = useSize(view);
  const floor = floorShownAt(plan, standing.z);
  const near = nearestPlace(floor, standing);
  const away = near === null ? 0 : Math.hypot(near.x - standing.x, near.y - standing.y);
  const across = Math.max(LEAST_ACROSS_M, 2.6 * away);
  // Names are laid out anew with each scale, so that it changes in steps.
  const scale = Math.max(1, Math.floor(Math.min(size.width, size.height) / across));
  const sight = centred(standing, scale, size);
  const names = useNames(floor, scale);
  const at = drawnAt(sight, standing.x, standing.y);
  const radius = Math.max(RADIUS_M * scale, LEAST_RADIUS_PX);
  const mark = { left: at.x - radius, top: at.y - radius, right: at.x + radius, bottom: at.y + radius };
  const { seen_s } = standing;
  const where = whereInWords(plan, standing);
  return (
    <figure class="place-map">
      <div class="plan-view" ref={view}>
        <FloorDrawing
          floor={floor}
          sight={sight}
          label={t("Map of {floor}: {robot} is {where}", { floor: floor.name, robot: name, where })}
        >
          <PlaceNames names={names} sight={sight} hidden={namesHidden(names, sight, size, [mark, FLOOR_SIGN])} />
          <g class={`plan-robot ${seen_s === null ? "robot-asking" : "robot-not-seen"}`}>
            <g class="plan-mark" transform={`translate(${at.x} ${at.y}) rotate(${(-standing.yaw * 180) / Math.PI}) scale(${radius})`}>
              <circle r={1} />
              <path d="M0.75 0L-0.35 0.5L-0.1 0L-0.35 -0.5Z" />
            </g>
          </g>
        </FloorDrawing>
        <span class="place-floor">{floor.name}</span>
      </div>
      <figcaption>
        {seen_s === null
          ? parts("{robot} is {where}.", { robot: <strong>{name}</strong>, where })
          : parts("{robot} was {where}: last seen {duration} ago.", {
              robot: <strong>{name}</strong>,
              where,
              duration: howLong(seen_s),
            })}
      </figcaption>
    </figure>
  );
}

/** The building of a run, which its first event has. */
function usePlan(run: string): Plan | null {
  const [plan, setPlan] = useState<Plan | null>(null);
  useEffect(() => {
    let wanted = true;
    rest.beginning(run).then(
      (started) => wanted && setPlan(started === null ? null : planOf(started.scene)),
      // Without it the card lacks a map, and nothing that is needed to answer.
      () => undefined,
    );
    return () => {
      wanted = false;
    };
  }, [run]);
  return plan;
}

/** Where a robot of a run is now, or was last; null while that is not known. */
function useStanding(run: string, robot: string): Standing | null {
  const [standing, setStanding] = useState<Standing | null>(null);
  const standings = useMemo(createStandings, [run]);
  useEffect(() => {
    let newest: Frame | null = null;
    let heard = performance.now();
    let index = -1;
    let state: WatchState = "connecting";
    let told = "";
    const look = () => {
      if (newest === null || index < 0) return;
      const silent_s = (performance.now() - heard) / 1000;
      const old_s = state === "watching" ? OLD_S : 0;
      const found = standings.at(newest, { time: newest.time, silent_s, old_s })[index] ?? null;
      // What is not to be seen on so small a map is no news.
      const text = JSON.stringify(found, (_, value) => (typeof value === "number" ? Math.round(value * 20) / 20 : value));
      if (text !== told) setStanding(found);
      told = text;
    };
    const stop = watchRun(run, helperName.peek(), {
      layout: ({ robots }) => void (index = robots.indexOf(robot)),
      frame(frame) {
        const first = newest === null;
        newest = frame;
        heard = performance.now();
        if (first) look();
      },
      state: (next) => void (state = next),
    });
    const timer = window.setInterval(look, LOOK_MS);
    return () => {
      stop();
      window.clearInterval(timer);
    };
  }, [run, robot]);
  return standing;
}
