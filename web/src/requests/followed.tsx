// How far one request is and when it is expected to be done, for who has asked for it.
import { useEffect, useRef, useState } from "preact/hooks";
import { robotName } from "../question/fault_words";
import { may } from "../state/access";
import * as rest from "../wire/rest";
import type { RequestView } from "../wire/types";
import { isOpenEnded, isOver, STATUS_SIGNS, STATUS_WORDS, wanted } from "./request_words";
import { Waits } from "./waits";
import { type SiteClock, when } from "./when";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";
import { ToldReason } from "../words/told";

interface FollowedProps {
  request: RequestView;
  clock: SiteClock;
  changed: () => void;
  /** At whose touch screen. */
  at?: string;
}

export function Followed({ request, clock, changed, at }: FollowedProps) {
  const [failure, setFailure] = useState("");
  const heading = useRef<HTMLHeadingElement>(null);
  useEffect(() => heading.current?.focus(), [request.name]);
  const cancel = () =>
    rest.cancelRequest(request.site, request.name).then(changed, (error: Error) => setFailure(whyNotDone(error)));
  const { status, reason } = request;
  return (
    <section class="panel followed" aria-label={t("Your request")}>
      <h2 ref={heading} tabIndex={-1}>
        {wanted(request)}
      </h2>
      <p role="status">
        <span class={`badge request-${status}`}>
          <span aria-hidden="true">{STATUS_SIGNS[status]}</span>
          {STATUS_WORDS[status]}
        </span>
      </p>
      <p>{soon(request, clock)}</p>
      <div role="status">
        <Waits request={request} at={at} />
      </div>
      {reason !== null && <p class="small"><ToldReason text={reason} /></p>}
      <p class="mistake" role="alert">
        {failure}
      </p>
      {!isOver(request) && status !== "returning" && may("helper") && (
        <button class="button" type="button" onClick={() => void cancel()}>
          {t("Cancel it")}
        </button>
      )}
    </section>
  );
}

/** Who does it, and when it is expected to be done. */
export function soon(request: RequestView, clock: SiteClock): string {
  const { expected, status } = request;
  if (isOver(request)) return OVER[status] ?? "";
  if (expected === null) return t("When it will be done is not known yet.");
  const said = { robot: robotName(expected.robot), when: when(expected.done_s, clock, new Date()) };
  return isOpenEnded(request, clock.now)
    ? t("{robot} is expected to be done with it at the earliest {when}.", said)
    : t("{robot} is expected to be done with it {when}.", said);
}

const OVER: Partial<Record<RequestView["status"], string>> = {
  done: t("It is done."),
  cancelled: t("It is wanted no more."),
  failed: t("It was not done."),
};
