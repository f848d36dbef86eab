// How the console speaks of requests: what is wanted, how far it is, and when it is done.
import { robotName } from "../question/fault_words";
import type { RequestStatus, RequestView } from "../wire/types";

export const STATUS_WORDS: Readonly<Record<RequestStatus, string>> = {
  booked: "Booked",
  waiting: "Waits for a robot",
  under_way: "Under way",
  returning: "Goes back",
  done: "Done",
  refused: "Refused",
  cancelled: "Cancelled",
  failed: "Failed",
};

/** Beside the word and the colour, a sign for those who do not tell colours. */
export const STATUS_SIGNS: Readonly<Record<RequestStatus, string>> = {
  booked: "◷",
  waiting: "‖",
  under_way: "▶",
  returning: "↩",
  done: "✓",
  refused: "✕",
  cancelled: "■",
  failed: "✕",
};

const OVER: ReadonlySet<RequestStatus> = new Set(["done", "refused", "cancelled", "failed"]);

export function isOver({ status }: RequestView): boolean {
  return OVER.has(status);
}

/** What somebody wants, in a sentence; `named` says how places are called. */
export function wanted({ what }: RequestView, named = (place: string) => place): string {
  const said = (field: string) => String(what[field] ?? "");
  const at = (field: string) => named(said(field));
  switch (what.kind) {
    case "transport":
      return `Bring ${said("what")} from ${at("origin")} to ${at("destination")}`;
    case "deliver_message":
      return `Tell “${said("message")}” at ${at("place")}`;
    case "escort":
      return `Show ${said("person")} the way from ${at("origin")} to ${at("destination")}`;
    default:
      return `Come to ${at("place")}`;
  }
}

/** When it is expected to be done, at `now` of the building's clock (seconds). */
export function expectation(request: RequestView, now: number | undefined): string {
  const { expected } = request;
  if (isOver(request) || expected === null || now === undefined) return "";
  return `${robotName(expected.robot)}, done ${within(expected.done_s - now)}`;
}

/** "in less than a minute", "in about 4 minutes" */
export function within(seconds: number): string {
  const minutes = Math.round(seconds / 60);
  if (minutes < 1) return "in less than a minute";
  return `in about ${minutes} ${minutes === 1 ? "minute" : "minutes"}`;
}
