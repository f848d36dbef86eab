// How the console speaks of requests: what is wanted, how far it is, and when it is done.
import { robotName } from "../question/fault_words";
import type { RequestStatus, RequestView } from "../wire/types";
import { t } from "../words/words";
import { placeInWords } from "./places";
import { ownSeconds, type SiteClock, within } from "./when";
import { isPointedAt } from "./wish";

export const STATUS_WORDS: Readonly<Record<RequestStatus, string>> = {
  booked: t("Booked"),
  waiting: t("Waits for a robot"),
  under_way: t("Under way"),
  returning: t("Goes back"),
  done: t("Done"),
  refused: t("Refused"),
  cancelled: t("Cancelled"),
  failed: t("Failed"),
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

/** What somebody wants, in a sentence. */
export function wanted({ what }: RequestView): string {
  const said = (field: string) => String(what[field] ?? "");
  const at = (field: string) => placeInWords(said(field));
  switch (what.kind) {
    case "transport":
      return isPointedAt(said("what"))
        ? t("Bring this from {from} to {to}", { from: at("origin"), to: at("destination") })
        : t("Bring {what} from {from} to {to}", { what: said("what"), from: at("origin"), to: at("destination") });
    case "deliver_message":
      return t("Tell “{message}” at {place}", { message: said("message"), place: at("place") });
    case "escort":
      return t("Show {person} the way from {from} to {to}", {
        person: said("person"),
        from: at("origin"),
        to: at("destination"),
      });
    default:
      return t("Come to {place}", { place: at("place") });
  }
}

/** When it is expected to be done, as people say it by their own clock. */
export function expectation(request: RequestView, clock: SiteClock | null): string {
  const { expected } = request;
  if (isOver(request) || expected === null || clock === null) return "";
  const when = { robot: robotName(expected.robot), within: within(ownSeconds(expected.done_s, clock)) };
  return isOpenEnded(request, clock.now) ? t("{robot}, done {within} at the earliest", when) : t("{robot}, done {within}", when);
}

/** Whether nobody can say until when: its robot is late already, or waits for people. */
export function isOpenEnded({ expected, waits }: RequestView, now: number): boolean {
  return waits !== null || (expected !== null && (expected.late_s > 0 || expected.done_s < now));
}
