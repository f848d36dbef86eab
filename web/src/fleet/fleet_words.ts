// How the console speaks of a fleet: what robots do and are to do, and what is known of ways.
import { likelyEllipse } from "../building/likely_ellipse";
import { robotName } from "../question/fault_words";
import { clock } from "../run/run_words";
import type { ClosedWayView, FleetRobot } from "../wire/types";

/** What a leg, or a stop of the plan, does with a request at its place. */
const ACTIONS: Readonly<Record<string, (request: string) => string>> = {
  visit: (request) => `comes for ${request}`,
  deliver_message: (request) => `tells ${request}`,
  meet: (request) => `meets the person of ${request}`,
  escort: (request) => `shows the way for ${request}`,
  collect: (request) => `collects ${request}`,
  hand_over: (request) => `hands over ${request}`,
  give: (request) => `passes ${request} on`,
  take: (request) => `takes ${request} over`,
  bring_back: (request) => `brings ${request} back`,
};

/** "collects tea", as a clause after a robot's name. */
export function doesInWords(action: string, request: string): string {
  return (ACTIONS[action] ?? (() => `${action} ${request}`))(request);
}

/** Who does not say who they are has a principal's name all the same. */
const UNNAMED: ReadonlySet<string> = new Set(["anybody", "token"]);

export function authorInWords(author: { principal: string } | null): string {
  return author === null || UNNAMED.has(author.principal) ? "somebody" : author.principal;
}

/** "F1 101" of "F1/101", as people read it. */
export function placeInWords(place: string): string {
  return place.replace("/", " ");
}

/** What a robot is at now, as a clause after its name. */
export function isAtInWords({ at_work, works, out_of_service, connected }: FleetRobot): string {
  if (at_work !== null) {
    const place = placeInWords(at_work.place);
    if (at_work.request === null || at_work.action === null) return at_work.charges ? `goes to ${place} to charge` : `goes to ${place}`;
    return `${doesInWords(at_work.action, at_work.request)} at ${place}`;
  }
  if (out_of_service !== null) return `is out of service: ${out_of_service}`;
  if (!connected) return "is not connected";
  return works ? "has nothing to do" : "does not work";
}

/** "The way between F1 101 and F1 hall is blocked until 5:00 (anna)." */
export function closedInWords({ between, finding, by, until_s }: ClosedWayView): string {
  const [from = "", to = ""] = between.map(placeInWords);
  const what = finding === "door_closed" ? "Door closed" : "Blocked";
  const who = by === null ? "" : `, says ${robotName(by)}`;
  return `${what} between ${from} and ${to} until ${wholeClock(until_s)}${who}`;
}

/** "3 cm": with a chance of 95 % a robot is so near to where it says that it is. */
export function sureInWords(covariance: readonly number[]): string {
  const { rx } = likelyEllipse(covariance);
  return rx < 1 ? `${Math.max(1, Math.ceil(100 * rx))} cm` : `${rx.toFixed(1)} m`;
}

/** A time of the site's clock without tenths. */
export function wholeClock(seconds: number): string {
  return clock(Math.round(seconds)).replace(".0", "");
}
