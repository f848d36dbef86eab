// While a robot watches for help that was promised, or is being helped: calm cards, nothing to answer.
import { helperName } from "../state/preferences";
import { type Question, stopHelping, type Together } from "../state/questions";
import type { Help } from "../wire/types";
import { AskingPlace } from "./asking_place";
import { TimeLeft, useSecondsUntil } from "./countdown";
import { robotName, spoken } from "./fault_words";
import { HelpCamera, seenBy } from "./help_camera";
import { PausedNode } from "./paused_node";
import { PromiseButtons } from "./promise_buttons";
import { t } from "../words/words";
import { Told } from "../words/told";
import "./waiting_cards.css";

const PROMISES: Readonly<Record<Help, (part: string) => string>> = {
  place: (part) => t("would place the {part}", { part }),
  put_back: (part) => t("would put the {part} back on the table", { part }),
  hand_over: (part) => t("would hand over the {part}", { part }),
  clear_way: () => t("would clear the way"),
  clear_view: () => t("would clear the view of the head camera"),
  tell_place: () => t("know where it is"),
  put_in: () => t("would put something into its basket"),
  take_out: () => t("would take something out of its basket"),
  charge: () => t("would plug it in"),
  send_person: () => t("would tell who is to follow it to come"),
};

const EXPECTED: Readonly<Record<Help, (part: string) => string>> = {
  place: (part) => t("The robot watches for the {part} at its place.", { part }),
  put_back: (part) => t("The robot watches for the {part} on the table, within its reach.", { part }),
  hand_over: (part) => t("The robot watches for the {part} between its fingers, and then grips it.", { part }),
  clear_way: () => t("The robot watches until nothing is in the way of its arm."),
  clear_view: () => t("The robot watches until its head camera sees the table."),
  tell_place: () => t("The robot looks whether what its laser sees agrees with that."),
  put_in: () => t("The robot waits until it feels that in its basket."),
  take_out: () => t("The robot waits until it feels that its basket is lighter."),
  charge: () => t("The robot waits until it feels current."),
  send_person: () => t("The robot waits until it sees them beside it."),
};

/** A base sees with its laser, and has no arm. */
function expected({ detection }: Question, help: Help, part: string): string {
  if (help === "clear_way" && detection?.camera === "laser") return t("The robot watches until its way is free.");
  return EXPECTED[help](part);
}

interface AwaitedHelpProps {
  question: Question;
  /** Beside the run's own drawing of the tree, which shows the paused node already. */
  besideTree?: boolean;
}

export function AwaitedHelpCard({ question, besideTree = false }: AwaitedHelpProps) {
  const { help } = question;
  const part = spoken(question.object ?? question.name);
  return (
    <article class="waiting panel" aria-label={t("{robot} awaits help", { robot: robotName(question.robot) })}>
      <header class="waiting-head">
        <p class="question-about">
          <strong>{robotName(question.robot)}</strong>
          <a href={`/runs/${question.run}`}>{t("Look at the run")}</a>
        </p>
        <Watching question={question} />
      </header>
      {question.prompt?.kind === "say" && (
        <p class="waiting-said" role="status">
          <Told text={question.prompt.text} />
        </p>
      )}
      {help !== null && (
        <p>
          {help.helper === helperName.value
            ? t("You said you {promise}.", { promise: PROMISES[help.help](part) })
            : t("{helper} said they {promise}.", { helper: help.helper, promise: PROMISES[help.help](part) })}{" "}
          {expected(question, help.help, part)}
        </p>
      )}
      <PromiseButtons question={question} />
      {help !== null && seenBy(question) !== null && <HelpCamera question={question} camera={seenBy(question)!} />}
      <AskingPlace question={question} />
      <p class="watching quiet small">{t("It goes on by itself as soon as it sees that.")}</p>
      {!besideTree && <PausedNode run={question.run} node={question.node} name={question.name} />}
    </article>
  );
}

/** How much longer it watches for what was promised. */
function Watching({ question: { run, help } }: { question: Question }) {
  const left = useSecondsUntil(run, help?.until ?? null);
  if (left === null || help === null) return null;
  if (left > 0) return <TimeLeft left={left} within={help.within_s} what={t("It gives you")} />;
  return <p class="quiet small">{t("Its time for that is over: it looks once more.")}</p>;
}

export function TogetherCard({ together }: { together: Together }) {
  return (
    <article class="waiting panel" aria-label={t("{robot} needs a hand now", { robot: robotName(together.robot) })}>
      <p class="question-about">
        <strong>{robotName(together.robot)}</strong>
        <a href={`/runs/${together.run}`}>{t("Look at the run")}</a>
      </p>
      <p class="waiting-said"><Told text={together.text} /></p>
      <p class="quiet small">{t("The robot has slowed down and goes on meanwhile. There is nothing to answer.")}</p>
      <button type="button" class="button" onClick={() => stopHelping((each) => each === together)}>{t("Seen")}</button>
    </article>
  );
}
