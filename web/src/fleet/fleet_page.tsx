// The fleet of a building: where its robots are, what they ask, do and are to do, and why.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { go } from "../app/router";
import { type Plan, planOf, type PlanFloor } from "../building/plan";
import { seenRobots } from "../building/seen_robots";
import type { Standing } from "../building/standing";
import { useFloor } from "../building/use_floor";
import { fleetAt, fleets } from "../requests/fleets";
import { isOver } from "../requests/request_words";
import { NobodyTakesAny, RequestList } from "../requests/requests_view";
import { useRequests } from "../requests/use_requests";
import { createMoment, type Moment } from "../run/moment";
import { useMomentInAddress } from "../run/moment_in_address";
import { siteName } from "../run/run_words";
import { Scrubber } from "../run/scrubber";
import { usePlaying } from "../run/use_playing";
import * as rest from "../wire/rest";
import type { FleetView, RequestView, SiteView } from "../wire/types";
import { FleetChart } from "./fleet_chart";
import { eventsUntil, type FleetEvent, legsAfter, requestsAfter } from "./fleet_past";
import { FleetPlan } from "./fleet_plan";
import { askingOf, FleetQuestions } from "./fleet_questions";
import { fleetAtWork, fleetAtWorkThen, standingsOf } from "./fleet_robots";
import type { Picked } from "./picked";
import { RobotsList } from "./robots_list";
import { useSilence } from "./silence";
import { usePastStandings } from "./use_past_standings";
import { useSiteEvents } from "./use_site_events";
import { WaysPanel } from "./ways_panel";
import { t, tn } from "../words/words";
import "./fleet.css";

const AGAIN_MS = 1_000;

export function FleetPage({ site }: { site: string | null }) {
  const sites = fleets.value;
  const shown = fleetAt(site);
  return (
    <section class="page fleet">
      <div class="page-head">
        <h1>{t("Fleet")}</h1>
        {sites !== null && sites.length > 1 && <SiteChoice sites={sites} site={shown} />}
      </div>
      {sites === null && <p class="quiet">{t("Loading …")}</p>}
      {sites !== null && shown === null && (site === null ? <NobodyTakesAny /> : <p>{t("There is no site of this address with a fleet.")}</p>)}
      {shown !== null && <OfSite key={shown.id} site={shown} />}
    </section>
  );
}

function SiteChoice({ sites, site }: { sites: readonly SiteView[]; site: SiteView | null }) {
  return (
    <div class="field">
      <label for="fleet-site">{t("Building")}</label>
      <select id="fleet-site" value={site?.id ?? ""} onChange={(event) => go(`/fleet/${event.currentTarget.value}`)}>
        {site === null && <option value="">{t("Choose a building")}</option>}
        {sites.map((each) => (
          <option key={each.id} value={each.id}>
            {siteName(each)}
          </option>
        ))}
      </select>
    </div>
  );
}

function OfSite({ site }: { site: SiteView }) {
  const { requests, fleet, heard, failure, again } = useRequests(site.id, AGAIN_MS);
  const events = useSiteEvents(site.id);
  const plan = useScenePlan(site.scene);
  const moment = useMemo(createMoment, [site.id]);
  usePlaying(moment);
  useEffect(() => {
    if (fleet !== null) moment.reach(fleet.now_s);
  }, [moment, fleet]);
  return (
    <>
      <p class="mistake" role="alert">
        {failure}
      </p>
      {(fleet === null || events === null || plan === null) && failure === "" && <p class="quiet">{t("Loading …")}</p>}
      {fleet !== null && events !== null && plan !== null && (
        <Shown {...{ site, fleet, heard, events, plan, moment, again }} requests={requests ?? []} />
      )}
    </>
  );
}

/** The building that a site's scene is set in. */
function useScenePlan(scene: string): Plan | null {
  const [plan, setPlan] = useState<Plan | null>(null);
  useEffect(() => {
    let wanted = true;
    rest.scene(scene).then(
      ({ definition }) => wanted && setPlan(planOf(definition)),
      // The scene is another one by now, or gone.
      () => undefined,
    );
    return () => {
      wanted = false;
    };
  }, [scene]);
  return plan;
}

interface ShownProps {
  site: SiteView;
  fleet: FleetView;
  /** When it was read, as `performance.now()`. */
  heard: number;
  events: readonly FleetEvent[];
  requests: readonly RequestView[];
  plan: Plan;
  moment: Moment;
  again(): void;
}

function Shown({ site, fleet, heard, events, requests, plan, moment, again }: ShownProps) {
  const newest = moment.newest.value;
  useMomentInAddress(moment, events.length > 0);
  const [picked, setPicked] = useState<Picked>(null);
  const names = fleet.robots.map(({ robot }) => robot);
  const live = useStandings(fleet, useSilence(heard));
  const then = usePastStandings(site.id, names, moment);
  const positions = newest ? live : then;
  const robots = newest
    ? fleetAtWork(fleet, plan, askingOf(names))
    : fleetAtWorkThen(fleet, plan, legsAfter(eventsUntil(events, moment.time.value)));
  const seen = seenRobots(robots, robots.map(({ robot }) => positions.get(robot) ?? null), { plan, past: !newest, atLeast: false });
  const [floor, setFloor] = useFloor(plan, seen);
  const show = (robot: string) => {
    const there = plan.floors.find(({ name }) => name === seen.find((each) => each.robot === robot)?.floor);
    if (there !== undefined) setFloor(there);
  };
  return (
    <>
      {newest && <FleetQuestions robots={names} />}
      <div class="fleet-columns">
        <FleetPlan
          {...{ plan, robots, seen, picked, floor, positions }}
          live={newest}
          closed={newest ? fleet.closed : []}
          onPick={setPicked}
          onFloor={(next: PlanFloor) => setFloor(next)}
          state={newest ? "" : pastInWords(positions.size > 0)}
        />
        {newest && (
          <div class="fleet-side">
            <RobotsList {...{ fleet, requests, seen, events }} onShow={show} changed={again} />
            <WaysPanel {...{ fleet, plan, picked }} floor={floor.name} onPick={setPicked} changed={again} />
          </div>
        )}
      </div>
      <FleetChart {...{ events, moment }} robots={fleet.robots} />
      <Requests {...{ site, requests, events, moment, again }} now={fleet.now_s} />
      <Scrubber of={t("the building")} moment={moment} going onStep={(direction) => step(events, moment, direction)} />
    </>
  );
}

/** What the plan does not show of a moment of the past. */
function pastInWords(known: boolean): string {
  return known ? t("Which ways were closed at that moment is not shown.") : t("Where robots were at that moment was not recorded.");
}

/** Where robots are, and whether they have moved since the last reading, `silent_s` ago. */
function useStandings(fleet: FleetView, silent_s: number): ReadonlyMap<string, Standing> {
  const before = useRef<ReadonlyMap<string, Standing>>(new Map());
  const now = useMemo(() => standingsOf(fleet, before.current, silent_s), [fleet, silent_s]);
  useEffect(() => {
    before.current = now;
  }, [now]);
  return now;
}

interface RequestsProps {
  site: SiteView;
  requests: readonly RequestView[];
  events: readonly FleetEvent[];
  moment: Moment;
  now: number;
  again(): void;
}

function Requests({ site, requests, events, moment, now, again }: RequestsProps) {
  const newest = moment.newest.value;
  const time = newest ? now : moment.time.value;
  const clock = { now: time, speed: site.speed };
  const shown = newest ? requests : requestsAfter(eventsUntil(events, time));
  const open = shown.filter((each) => !isOver(each));
  const over = shown.filter(isOver).reverse();
  return (
    <section class="fleet-requests" aria-labelledby="fleet-requests-title">
      <div class="page-head">
        <h2 id="fleet-requests-title">{t("Requests")}</h2>
        <a href="/requests">{t("Ask for something")}</a>
      </div>
      {open.length === 0 && <p class="quiet">{newest ? t("Nothing is asked for just now.") : t("Nothing is asked for at that moment.")}</p>}
      <RequestList label={t("Open requests")} requests={open} clock={clock} {...(newest && { changed: again })} />
      {over.length > 0 && (
        <details>
          <summary>{tn("{count} that is over", "{count} that are over", { count: over.length })}</summary>
          <RequestList label={t("Requests that are over")} requests={over} clock={clock} />
        </details>
      )}
    </section>
  );
}

/** Go to the event before or after the moment that is shown. */
function step(events: readonly FleetEvent[], moment: Moment, direction: -1 | 1): void {
  const time = moment.time.peek();
  const next =
    direction < 0 ? events.findLast(({ at_s }) => at_s < time - 1e-6) : events.find(({ at_s }) => at_s > time + 1e-6);
  if (next === undefined && direction > 0) moment.goToNewest();
  else if (next !== undefined) moment.goTo(next.at_s, next.seq);
}
