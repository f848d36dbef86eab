// The robots of a fleet in words, and what an operator may have each do.
import { useState } from "preact/hooks";
import { Confirm } from "../app/confirm";
import { ACTIVITY_SIGNS, ACTIVITY_WORDS } from "../building/at_work";
import type { SeenRobot } from "../building/seen_robots";
import { robotName } from "../question/fault_words";
import { placeInWords } from "../requests/places";
import { sentence } from "../run/run_words";
import { may } from "../state/access";
import * as rest from "../wire/rest";
import type { ErrandEnded, FleetRobot, FleetView, RequestView } from "../wire/types";
import type { FleetEvent } from "./fleet_past";
import { hasInWords, isAtInWords, sureInWords, wholeClock } from "./fleet_words";
import { useRefusal } from "./use_refusal";
import { reasonInWords, whyNotDone } from "../words/said";
import { t } from "../words/words";

interface RobotsListProps {
  fleet: FleetView;
  requests: readonly RequestView[];
  seen: readonly SeenRobot[];
  events: readonly FleetEvent[];
  onShow(robot: string): void;
  /** Something was done: look what has become of it. */
  changed(): void;
}

/** Of more robots what may be done is folded, so that they stand together with the plan. */
const FEW = 6;

export function RobotsList({ fleet, requests, seen, events, onShow, changed }: RobotsListProps) {
  return (
    <section class="panel" aria-labelledby="fleet-robots-title">
      <h2 id="fleet-robots-title">{t("Robots")}</h2>
      <ul class="plan-robots" aria-label={t("Robots of the fleet")}>
        {fleet.robots.map((robot) => {
          const found = seen.find((each) => each.robot === robot.robot);
          return found === undefined ? null : (
            <Row key={robot.robot} {...{ fleet, requests, robot, seen: found, onShow, changed }} came={lastErrand(events, robot.robot)} />
          );
        })}
      </ul>
    </section>
  );
}

/** How its last errand ended, as long as it has not begun anything since. */
function lastErrand(events: readonly FleetEvent[], robot: string): ErrandEnded | null {
  const last = events.findLast((event) => "robot" in event && event.robot === robot && BEGINS_OR_ENDS.has(event.type));
  return last?.type === "errand_ended" ? last : null;
}

const BEGINS_OR_ENDS: ReadonlySet<string> = new Set(["leg_begun", "leg_ended", "errand_begun", "errand_ended"]);

interface RowProps {
  fleet: FleetView;
  requests: readonly RequestView[];
  robot: FleetRobot;
  seen: SeenRobot;
  came: ErrandEnded | null;
  onShow(robot: string): void;
  changed(): void;
}

function Row({ fleet, requests, robot, seen, came, onShow, changed }: RowProps) {
  const where = seen.where === null ? t("Nobody knows where it is") : sentence(seen.unseen === null ? seen.where : `${seen.unseen}, ${seen.where}`).slice(0, -1);
  return (
    <li class="plan-row fleet-robot">
      <div class="fleet-robot-head">
        <button type="button" class="small-button" disabled={seen.where === null} onClick={() => onShow(robot.robot)}>
          <span class="unseen">{t("Show")}{" "}</span>
          {seen.name}
        </button>
        <State robot={robot} seen={seen} />
        {robot.run !== null && (
          <a class="small" href={`/runs/${robot.run}`}>{t("Run")}<span class="unseen">{" "}{t("of {name}", { name: seen.name })}</span>
          </a>
        )}
      </div>
      <p class="small">
        {where}
        {robot.pose?.covariance != null && ` ${t("(sure to {distance})", { distance: sureInWords(robot.pose.covariance) })}`}; {isAtInWords(robot)}.{robot.battery !== null && ` ${t("Battery {percent} %.", { percent: Math.round(100 * robot.battery) })}`}{robot.aboard.length > 0 && ` ${hasInWords(robot, requests)}`}
      </p>
      {came !== null && <p class="small quiet">{errandInWords(came)}</p>}
      {may("operator") && (fleet.robots.length > FEW ? <FoldedDeeds {...{ fleet, robot, changed }} /> : <Deeds {...{ fleet, robot, changed }} />)}
    </li>
  );
}

function errandInWords({ came, place, at, at_s, reason }: ErrandEnded): string {
  if (came) return t("It came to {place} at {time}.", { place: placeInWords(place), time: wholeClock(at_s) });
  return t("It did not come to {place}: {why} It stopped near {near} at {time}.", { place: placeInWords(place), why: sentence(reason === null ? t("nobody knows why") : reasonInWords(reason)), near: placeInWords(at), time: wholeClock(at_s) });
}

function State({ robot, seen: { activity, unseen, where } }: { robot: FleetRobot; seen: SeenRobot }) {
  if (robot.out_of_service !== null) return <span class="badge plan-badge robot-waiting">{t("⊘ Out of service")}</span>;
  if (unseen !== null || where === null || !robot.connected) return <span class="badge plan-badge">{t("✕ Not seen")}</span>;
  return (
    <span class={`badge plan-badge robot-${activity}`}>
      {ACTIVITY_SIGNS[activity]} {ACTIVITY_WORDS[activity]}
    </span>
  );
}

type Asked = "send" | "out" | null;

interface DeedsProps {
  fleet: FleetView;
  robot: FleetRobot;
  changed(): void;
}

function FoldedDeeds(props: DeedsProps) {
  return (
    <details class="fleet-folded">
      <summary class="small">
        {t("Send it, or take it out of service")}
        <span class="unseen"> {robotName(props.robot.robot)}</span>
      </summary>
      <Deeds {...props} />
    </details>
  );
}

function Deeds({ fleet, robot, changed }: DeedsProps) {
  const [asked, setAsked] = useState<Asked>(null);
  const [failure, setFailure] = useRefusal(JSON.stringify([robot.at_work, robot.out_of_service]), fleet);
  const name = robotName(robot.robot);
  const run = (deed: Promise<void>) => {
    setAsked(null);
    setFailure("");
    void deed.catch((error: Error) => setFailure(sentence(whyNotDone(error)))).then(changed);
  };
  const send = (place: string) => run(rest.sendRobot(fleet.site, robot.robot, place));
  return (
    <>
      <div class="fleet-deeds">
        <Deed of={name} onDo={() => send(robot.home)}>{t("Send home")}</Deed>
        <Deed of={name} onDo={() => setAsked("send")}>{t("Send …")}</Deed>
        {robot.out_of_service === null ? (
          <Deed of={name} onDo={() => setAsked("out")}>{t("Out of service …")}</Deed>
        ) : (
          <Deed of={name} onDo={() => run(rest.putRobotBack(fleet.site, robot.robot))}>{t("Back in service")}</Deed>
        )}
      </div>
      <p class="mistake small" role="alert">
        {failure}
      </p>
      {asked === "send" && <SendTo name={name} places={fleet.places} onSend={send} onCancel={() => setAsked(null)} />}
      {asked === "out" && (
        <TakeOut name={name} onTake={(reason) => run(rest.takeRobotOut(fleet.site, robot.robot, reason))} onCancel={() => setAsked(null)} />
      )}
    </>
  );
}

/** A button that says of which robot it is to who does not see where it stands. */
function Deed({ of, onDo, children }: { of: string; onDo(): void; children: string }) {
  return (
    <button type="button" class="small-button" onClick={onDo}>
      {children}
      <span class="unseen"> {of}</span>
    </button>
  );
}

interface SendToProps {
  name: string;
  places: readonly string[];
  onSend(place: string): void;
  onCancel(): void;
}

function SendTo({ name, places, onSend, onCancel }: SendToProps) {
  const [place, setPlace] = useState(places[0] ?? "");
  return (
    <Confirm title={t("Send {name} where?", { name })} confirm={t("Send it")} harmless onConfirm={() => onSend(place)} onCancel={onCancel}>
      <div class="field fleet-asked-for">
        <label for="fleet-send-to">{t("Place")}</label>
        <select id="fleet-send-to" value={place} onChange={(event) => setPlace(event.currentTarget.value)}>
          {places.map((each) => (
            <option key={each} value={each}>
              {placeInWords(each)}
            </option>
          ))}
        </select>
      </div>
      <p class="small quiet">{t("What it is to do for people it begins once it is there.")}</p>
    </Confirm>
  );
}

const LONGEST = 300;

function TakeOut({ name, onTake, onCancel }: { name: string; onTake(reason: string): void; onCancel(): void }) {
  const [reason, setReason] = useState("");
  const [mistake, setMistake] = useState("");
  const take = () => (reason.trim() === "" ? setMistake(t("Say why: others will see it.")) : onTake(reason.trim()));
  return (
    <Confirm title={t("Take {name} out of service?", { name })} confirm={t("Take it out")} onConfirm={take} onCancel={onCancel}>
      <p>{t("It breaks off what it does, and others fetch what it has aboard.")}</p>
      <div class="field fleet-asked-for">
        <label for="fleet-out-why">{t("Why")}</label>
        <input id="fleet-out-why" type="text" maxLength={LONGEST} value={reason} onInput={(event) => setReason(event.currentTarget.value)} />
      </div>
      <p class="mistake" role="alert">
        {mistake}
      </p>
    </Confirm>
  );
}
