// The robots that the service knows, those first that somebody has to see after.
import { useEffect } from "preact/hooks";
import { robotName } from "../question/fault_words";
import { fleets } from "../requests/fleets";
import { questions } from "../state/questions";
import { readRobots, robots } from "../state/robots";
import type { RobotView } from "../wire/types";
import { t } from "../words/words";
import { HomeList } from "./home_list";
import { robotsInOrder, type Standing, standingOf } from "./robot_standing";

/** Whether a robot works or waits changes with each of its steps. */
const AGAIN_MS = 5_000;

const WORDS: Readonly<Record<Standing, string>> = {
  lost: t("Gone"),
  asking: t("Asks a question"),
  holding: t("Waits|a robot"),
  working: t("Works|a robot"),
  idle: t("Has nothing to do"),
};

export function RobotsHere() {
  useEffect(() => {
    const read = () => document.visibilityState !== "hidden" && void readRobots().catch(() => undefined);
    const timer = window.setInterval(read, AGAIN_MS);
    read();
    return () => window.clearInterval(timer);
  }, []);
  if (robots.value.length === 0) return null;
  const asking = new Set(questions.value.map(({ robot }) => robot));
  const atFleets = (fleets.value?.length ?? 0) > 0;
  return (
    <HomeList
      id="home-robots"
      title={t("Robots")}
      href={atFleets ? "/fleet" : "/models"}
      all={atFleets ? t("The fleet") : t("How robots are drawn")}
      items={robotsInOrder(robots.value, asking).map((each) => (
        <Robot key={each.robot} robot={each} standing={standingOf(each, asking)} />
      ))}
    />
  );
}

function Robot({ robot, standing }: { robot: RobotView; standing: Standing }) {
  const name = robotName(robot.robot);
  return (
    <li>
      {robot.run === null ? <span>{name}</span> : <a href={`/runs/${robot.run}`}>{name}</a>}
      <span class={`home-state ${standing === "lost" || standing === "asking" ? "home-asks" : ""}`}>{WORDS[standing]}</span>
      <span class="small quiet">{robot.simulated ? t("simulated") : t("real")}</span>
    </li>
  );
}
