// How the console speaks of a fleet: what robots do and are to do, and what is known of ways.
import { likelyEllipse } from "../building/likely_ellipse";
import { robotName } from "../question/fault_words";
import { placeInWords } from "../requests/places";
import { clock } from "../run/run_words";
import { isPointedAt } from "../requests/wish";
import type { ClosedWayView, FleetRobot, RequestView } from "../wire/types";
import { decimal, t } from "../words/words";

/** What a leg, or a stop of the plan, does with a request at its place. */
const ACTIONS: Readonly<Record<string, (request: string) => string>> = {
  visit: (request) => t("comes for {request}", { request }),
  deliver_message: (request) => t("tells {request}", { request }),
  meet: (request) => t("meets the person of {request}", { request }),
  escort: (request) => t("shows the way for {request}", { request }),
  collect: (request) => t("collects {request}", { request }),
  hand_over: (request) => t("hands over {request}", { request }),
  give: (request) => t("passes {request} on", { request }),
  take: (request) => t("takes {request} over", { request }),
  bring_back: (request) => t("brings {request} back", { request }),
};

/** "collects tea", as a clause after a robot's name. */
export function doesInWords(action: string, request: string): string {
  return (ACTIONS[action] ?? (() => `${action} ${request}`))(request);
}

/** Who does not say who they are has a principal's name all the same. */
const UNNAMED: ReadonlySet<string> = new Set(["anybody", "token"]);

export function authorInWords(author: { principal: string } | null): string {
  return author === null || UNNAMED.has(author.principal) ? t("somebody") : author.principal;
}

/** What a robot is at now, as a clause after its name. */
export function isAtInWords({ at_work, works, out_of_service, connected }: FleetRobot): string {
  if (at_work !== null) {
    const place = placeInWords(at_work.place);
    if (at_work.request === null || at_work.action === null)
      return at_work.charges ? t("goes to {place} to charge", { place }) : t("goes to {place}", { place });
    return t("{action} at {place}", { action: doesInWords(at_work.action, at_work.request), place });
  }
  if (out_of_service !== null) return t("is out of service: {why}", { why: out_of_service });
  if (!connected) return t("is not connected");
  return works ? t("has nothing to do") : t("does not work");
}

/** What a robot has aboard, and whom it leads, as people call them: "It has the mail aboard. It shows Ms Lee the way." */
export function hasInWords({ aboard }: FleetRobot, requests: readonly RequestView[]): string {
  const things: string[] = [];
  const people: string[] = [];
  for (const name of aboard) {
    const what = requests.find((each) => each.name === name)?.what ?? {};
    if (what.kind === "escort") people.push(String(what.person));
    else things.push(what.kind === "transport" && !isPointedAt(String(what.what)) ? String(what.what) : name);
  }
  return [
    ...(things.length > 0 ? [t("It has {aboard} aboard.", { aboard: things.join(", ") })] : []),
    ...(people.length > 0 ? [t("It shows {people} the way.", { people: people.join(", ") })] : []),
  ].join(" ");
}

/** "The way between F1 101 and F1 hall is blocked until 5:00 (anna)." */
export function closedInWords({ between, finding, by, until_s }: ClosedWayView): string {
  const [from = "", to = ""] = between.map(placeInWords);
  const names = { from, to, time: wholeClock(until_s) };
  const told =
    finding === "door_closed"
      ? t("Door closed between {from} and {to} until {time}", names)
      : t("Blocked between {from} and {to} until {time}", names);
  return by === null ? told : t("{told}, says {by}", { told, by: robotName(by) });
}

/** "3 cm": with a chance of 95 % a robot is so near to where it says that it is. */
export function sureInWords(covariance: readonly number[]): string {
  const { rx } = likelyEllipse(covariance);
  return rx < 1 ? `${Math.max(1, Math.ceil(100 * rx))} cm` : `${decimal(rx, 1)} m`;
}

/** A time of the site's clock without tenths. */
export function wholeClock(seconds: number): string {
  return clock(Math.round(seconds)).replace(/[.,]0(?= s$|$)/, "");
}
