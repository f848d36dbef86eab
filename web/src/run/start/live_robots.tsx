// The choice among the robots that are connected, as they come and go.
import { useEffect, useState } from "preact/hooks";
import * as rest from "../../wire/rest";
import type { RobotView } from "../../wire/types";
import { type Filled, withChosen } from "./filled";
import { connectedOnes, placesOf } from "./standing";
import { t } from "../../words/words";

const AGAIN_MS = 2000;

interface LiveRobotsProps {
  known: readonly RobotView[];
  filled: Filled;
  fill: (change: Partial<Filled>) => void;
}

export function LiveRobots({ known, filled, fill }: LiveRobotsProps) {
  const robots = connectedOnes(useRobots(known));
  useEffect(() => {
    let given = true;
    // Where the tree cannot be read, its start says so.
    placesOf(filled.tree).catch(() => []).then((places) => {
      if (given) fill({ places });
    });
    return () => {
      given = false;
    };
  }, [filled.tree]);
  return (
    <fieldset class="start-robots" aria-describedby="start-robots-mistake">
      <legend>{t("Robots")}</legend>
      {robots.length === 0 && <p class="quiet">{t("No robot is connected.")}</p>}
      {filled.places.length === 0
        ? robots.map((robot) => <RobotBox key={robot.robot} robot={robot} filled={filled} fill={fill} />)
        : filled.places.map((place) => <PlaceChoice key={place} place={place} robots={robots} filled={filled} fill={fill} />)}
    </fieldset>
  );
}

function RobotBox({ robot: { robot, state }, filled, fill }: Omit<LiveRobotsProps, "known"> & { robot: RobotView }) {
  const toggle = (wanted: boolean) =>
    fill({ robots: wanted ? [...filled.robots, robot] : filled.robots.filter((each) => each !== robot) });
  return (
    <label class="choice">
      <input type="checkbox" checked={filled.robots.includes(robot)} onChange={(event) => toggle(event.currentTarget.checked)} />
      <span>
        <strong>{robot}</strong>
        <span class="small quiet">{state}</span>
      </span>
    </label>
  );
}

function PlaceChoice({ place, robots, filled, fill }: Omit<LiveRobotsProps, "known"> & { place: string; robots: readonly RobotView[] }) {
  const chosen = filled.standing[place] ?? "";
  const choose = (robot: string) => fill({ standing: { ...filled.standing, [place]: robot } });
  return (
    <div class="field">
      <label for={`start-place-${place}`}>{place}</label>
      <select id={`start-place-${place}`} value={chosen} onChange={(event) => choose(event.currentTarget.value)}>
        <option value="">{t("Nobody")}</option>
        {withChosen(robots.map(({ robot }) => robot), chosen).map((robot) => (
          <option key={robot}>{robot}</option>
        ))}
      </select>
    </div>
  );
}

/** The service's robots, asked for again and again. */
function useRobots(known: readonly RobotView[]): readonly RobotView[] {
  const [robots, setRobots] = useState(known);
  useEffect(() => {
    // While there is no connection those that were known last are shown.
    const look = () => void rest.robots().then(setRobots, () => {});
    look();
    const timer = window.setInterval(look, AGAIN_MS);
    return () => window.clearInterval(timer);
  }, []);
  return robots;
}
