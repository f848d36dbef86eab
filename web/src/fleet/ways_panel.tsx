// The ways that are closed now, and what an operator says of the way or the place that is picked.
import { useState } from "preact/hooks";
import type { Plan, PlanLane } from "../building/plan";
import { robotName } from "../question/fault_words";
import { placeInWords } from "../requests/places";
import { sentence } from "../run/run_words";
import { may, whyNot } from "../state/access";
import * as rest from "../wire/rest";
import type { ClosedWayView, FleetView, WayReport } from "../wire/types";
import { closedInWords } from "./fleet_words";
import { closedWay, type Picked, sameWay } from "./picked";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";

/** For how long something is said to be so, minutes; 0 until it is forgotten by itself. */
const SPANS: readonly (readonly [number, string])[] = [
  [0, t("as long as usual")],
  [10, t("10 minutes")],
  [60, t("1 hour")],
  [480, t("8 hours")],
];

interface WaysPanelProps {
  fleet: FleetView;
  plan: Plan;
  floor: string;
  picked: Picked;
  onPick(picked: Picked): void;
  changed(): void;
}

export function WaysPanel(props: WaysPanelProps) {
  const { fleet, picked, changed } = props;
  const [failure, setFailure] = useState("");
  const run = (deed: Promise<void>) => {
    setFailure("");
    void deed.then(changed, (error: Error) => setFailure(sentence(whyNotDone(error))));
  };
  const tell = (way: WayReport) => run(rest.tellOfWay(fleet.site, way));
  return (
    <section class="panel fleet-ways" aria-labelledby="fleet-ways-title">
      <h2 id="fleet-ways-title">{t("Ways")}</h2>
      <ClosedWays closed={fleet.closed} tell={tell} />
      {may("operator") ? <CloseWay {...props} tell={tell} /> : <p class="quiet small">{whyNot(t("Closing a way"), "operator")}</p>}
      {may("operator") && picked?.kind === "place" && (
        <SendHere place={picked.place} fleet={fleet} onSend={(robot) => run(rest.sendRobot(fleet.site, robot, picked.place))} />
      )}
      <p class="mistake small" role="alert">
        {failure}
      </p>
    </section>
  );
}

function ClosedWays({ closed, tell }: { closed: readonly ClosedWayView[]; tell(way: WayReport): void }) {
  if (closed.length === 0) return <p class="small quiet">{t("No way is closed.")}</p>;
  return (
    <ul class="closed-ways" aria-label={t("Ways that are closed now")}>
      {closed.map((each) => (
        <li key={each.between.join(" ")} class="plan-row">
          <span class="small">{closedInWords(each)}.</span>
          {may("operator") && (
            <button
              type="button"
              class="small-button"
              onClick={() => tell({ finding: "open", between: each.between as [string, string] })}
            >{t("It is open")}<span class="unseen">{" "}{t("between {places}", { places: each.between.map(placeInWords).join(t(" and ")) })}</span>
            </button>
          )}
        </li>
      ))}
    </ul>
  );
}

function CloseWay({ fleet, plan, floor, picked, onPick, tell }: WaysPanelProps & { tell(way: WayReport): void }) {
  const [minutes, setMinutes] = useState(0);
  const shown = plan.floors.find(({ name }) => name === floor);
  const named = (lane: PlanLane) => lane.between.map((each) => `${floor}/${each}`) as [string, string];
  const lanes = shown?.lanes ?? [];
  const index = picked?.kind === "way" ? lanes.findIndex((lane) => sameWay(named(lane), picked.between)) : -1;
  const lane = lanes[index];
  const close = (finding: WayReport["finding"]) => {
    if (lane === undefined) return;
    tell({ finding, between: named(lane), until_s: minutes === 0 ? null : fleet.now_s + 60 * minutes });
  };
  const already = lane !== undefined && closedWay(fleet.closed, named(lane)) !== undefined;
  return (
    <div class="close-way">
      <div class="field">
        <label for="fleet-way">{t("Way on {floor} (or pick it on the plan)", { floor })}</label>
        <select
          id="fleet-way"
          value={String(index)}
          onChange={(event) => {
            const chosen = lanes[Number(event.currentTarget.value)];
            onPick(chosen === undefined ? null : { kind: "way", between: named(chosen) });
          }}
        >
          <option value="-1">{t("Choose a way")}</option>
          {lanes.map((each, at) => (
            <option key={each.between.join(" ")} value={String(at)}>
              {each.between.join(" – ")}
              {each.door !== null && t(", door {name}", { name: each.door.name })}
            </option>
          ))}
        </select>
      </div>
      <div class="field">
        <label for="fleet-way-span">{t("For")}</label>
        <select id="fleet-way-span" value={String(minutes)} onChange={(event) => setMinutes(Number(event.currentTarget.value))}>
          {SPANS.map(([each, word]) => (
            <option key={each} value={String(each)}>
              {word}
            </option>
          ))}
        </select>
      </div>
      <div class="fleet-deeds">
        <button type="button" class="button" disabled={lane === undefined || already} onClick={() => close("blocked")}>{t("Blocked")}</button>
        <button type="button" class="button" disabled={(lane?.door ?? null) === null || already} onClick={() => close("door_closed")}>{t("Door closed")}</button>
      </div>
      <p class="small quiet">{t("Plans lead round it from then on; a robot on its way still goes by what it sees.")}</p>
    </div>
  );
}

function SendHere({ place, fleet, onSend }: { place: string; fleet: FleetView; onSend(robot: string): void }) {
  const [robot, setRobot] = useState(fleet.robots[0]?.robot ?? "");
  return (
    <div class="close-way" role="group" aria-label={t("Send a robot to {place}", { place: placeInWords(place) })}>
      <div class="field">
        <label for="fleet-send-here">{t("Send to {place}", { place: placeInWords(place) })}</label>
        <select id="fleet-send-here" value={robot} onChange={(event) => setRobot(event.currentTarget.value)}>
          {fleet.robots.map((each) => (
            <option key={each.robot} value={each.robot}>
              {robotName(each.robot)}
            </option>
          ))}
        </select>
      </div>
      <button type="button" class="button" disabled={!fleet.places.includes(place)} onClick={() => onSend(robot)}>{t("Go there")}</button>
      {!fleet.places.includes(place) && <p class="small quiet">{t("Robots are not sent there: the scene names no place.")}</p>}
    </div>
  );
}
