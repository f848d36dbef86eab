// While a robot watches for help that was promised, or is being helped: calm cards, nothing to answer.
import { helperName } from "../state/preferences";
import { type Question, stopHelping, type Together } from "../state/questions";
import { AskingPlace } from "./asking_place";
import { TimeLeft, useSecondsUntil } from "./countdown";
import { robotName } from "./fault_words";
import { HelpCamera, seenBy } from "./help_camera";
import { PausedNode } from "./paused_node";
import { promised, watchedFor } from "./promised_words";
import { PromiseButtons } from "./promise_buttons";
import { t } from "../words/words";
import { Told } from "../words/told";
import "./waiting_cards.css";

interface AwaitedHelpProps {
  question: Question;
  /** Beside the run's own drawing of the tree, which shows the paused node already. */
  besideTree?: boolean;
}

export function AwaitedHelpCard({ question, besideTree = false }: AwaitedHelpProps) {
  const { help } = question;
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
            ? t("You said you {promise}.", { promise: promised(question, help.help) })
            : t("{helper} said they {promise}.", { helper: help.helper, promise: promised(question, help.help) })}{" "}
          {watchedFor(question, help.help)}
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
