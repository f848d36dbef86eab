// How long a question waits: told calmly, and out loud only once, before it is too late.
import { useEffect, useState } from "preact/hooks";
import type { Question } from "../state/questions";
import { may } from "../state/access";
import { runs } from "../state/service";
import { command } from "../state/service";
import { runTime } from "../state/run_clock";
import { t } from "../words/words";
import { whyNotDone } from "../words/said";
import "./countdown.css";

/** The warning comes this long before the end, so that there is time to ask for more. */
const WARN_S = 25;

export function Countdown({ question }: { question: Question }) {
  const left = useSecondsLeft(question);
  const { prompt } = question;
  if (prompt === null) return null;
  if (!question.interrupts) return <p class="countdown">{t("It does not wait")}</p>;
  if (left === null) return null;
  const late = left <= WARN_S;
  return (
    <div class={`countdown ${late ? "late" : ""}`}>
      <TimeLeft left={left} within={prompt.within_s} what={t("The robot waits for")} />
      <p class="unseen" role="status">
        {late && left > 0 ? t("Less than 25 seconds are left to answer. You can ask for more time.") : ""}
      </p>
    </div>
  );
}

/** Lets whoever cannot be in time have the robot wait for longer. */
export function MoreTime({ question }: { question: Question }) {
  const [mistake, setMistake] = useState("");
  const { prompt } = question;
  if (prompt === null || prompt.deadline === null || prompt.extensions_left === 0 || !question.interrupts || !may("helper")) return null;
  const more = () => {
    setMistake("");
    command({ type: "extend", dialogue: question.dialogue, prompt: prompt.prompt }).catch((error: Error) =>
      setMistake(whyNotDone(error)),
    );
  };
  return (
    <div class="more-time">
      <button type="button" class="button" onClick={more}>
        {t("More time")}
      </button>
      {mistake !== "" && (
        <p class="mistake small" role="status">
          {mistake}
        </p>
      )}
    </div>
  );
}

/** A ring that runs out, and the time that is left; `what` is said before that where it is read out. */
export function TimeLeft({ left, within, what }: { left: number; within: number | null; what: string }) {
  return (
    <p class="countdown-time" role="timer" aria-live="off">
      <svg viewBox="0 0 20 20" width="20" height="20" aria-hidden="true">
        <circle cx="10" cy="10" r="8" class="ring" />
        <circle cx="10" cy="10" r="8" class="ring-left" pathLength="100" stroke-dasharray={dashes(left, within)} />
      </svg>
      <span class="unseen">{what} </span>
      {clock(left)}
      <span class="unseen"> {t("more.")}</span>
    </p>
  );
}

/** Until nobody waits for an answer any more; null where that is not so, or a run is paused. */
export function useSecondsLeft({ run, prompt }: Question): number | null {
  return useSecondsUntil(run, prompt?.deadline ?? null);
}

/** Until a time of a run's clock; null for no time, or while the run is paused. */
export function useSecondsUntil(of: string, time: number | null): number | null {
  const [, tick] = useState(0);
  useEffect(() => {
    const timer = window.setInterval(() => tick((count) => count + 1), 1000);
    return () => window.clearInterval(timer);
  }, []);
  if (time === null) return null;
  const run = runs.value.get(of);
  if (run?.status === "paused") return null;
  return Math.max(0, Math.ceil(time - runTime(of, run?.speed ?? 1)));
}

function dashes(left: number, within: number | null): string {
  const part = within === null || within <= 0 ? 1 : Math.min(1, left / within);
  return `${(part * 100).toFixed(1)} 100`;
}

/** Minutes and seconds, as on a kitchen timer. */
export function clock(seconds: number): string {
  return `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
}
