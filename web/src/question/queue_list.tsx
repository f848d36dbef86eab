// The open questions at a glance, the most urgent first; those that may be answered alike are one entry.
import { may } from "../state/access";
import { helperName } from "../state/preferences";
import { dialogueOf, type Question } from "../state/questions";
import type { QuestionBatchView, QuestionView } from "../wire/types";
import { clock, useSecondsLeft } from "./countdown";
import { faultInWords, robotName, spoken } from "./fault_words";
import { ForAll } from "./for_all";
import { choose, queue } from "./queue";
import { useBatches } from "./use_batches";
import { t } from "../words/words";
import { Told } from "../words/told";
import "./queue_list.css";

export function QueueList({ shown }: { shown: Question | null }) {
  const batches = useBatches();
  return (
    <section aria-labelledby="queue-title" class="queue">
      <h2 id="queue-title">{t("{count} questions", { count: queue.value.length })}</h2>
      <ol>
        {batches.map((batch) => (
          <li key={batch.questions[0]?.prompt}>
            {batch.questions.length > 1 ? (
              <Batch batch={batch} shown={shown} />
            ) : (
              batch.questions.map((each) => <Entry key={each.prompt} entry={each} shown={shown} />)
            )}
          </li>
        ))}
      </ol>
    </section>
  );
}

function Batch({ batch, shown }: { batch: QuestionBatchView; shown: Question | null }) {
  const { questions, headline, at_once } = batch;
  return (
    <details class="queue-batch" open={questions.some((each) => each.dialogue === shown?.dialogue)}>
      <summary>
        <b>{questions.length}×</b> <Told text={headline} />
        <Left dialogue={questions[0]?.dialogue} />
      </summary>
      <ol>
        {questions.map((each) => (
          <li key={each.prompt}>
            <Entry entry={each} shown={shown} />
          </li>
        ))}
      </ol>
      {may("helper") && at_once.length > 0 && <ForAll ways={at_once} prompts={questions.map((each) => each.prompt)} />}
    </details>
  );
}

function Entry({ entry, shown }: { entry: QuestionView; shown: Question | null }) {
  const question = dialogueOf(entry.dialogue);
  if (question === undefined) return null;
  return (
    <button
      type="button"
      class="queue-item"
      aria-current={entry.dialogue === shown?.dialogue ? "true" : undefined}
      onClick={() => choose(entry.dialogue)}
    >
      <span class="queue-robot">
        {robotName(entry.robot)}
        <span class="queue-task">{spoken(entry.tree)}</span>
        <Left dialogue={entry.dialogue} />
      </span>
      <span>{faultInWords(question)}</span>
      <span class="queue-where">
        {entry.place !== null && `${t("To {place}.", { place: spoken(entry.place) })} `}
        {t("Attempt {attempt} of {attempts}", { attempt: entry.attempt, attempts: entry.attempts })}
      </span>
      <Taken by={entry.claimed_by} asked={entry.to} />
    </button>
  );
}

function Left({ dialogue }: { dialogue: string | undefined }) {
  const question = dialogue === undefined ? undefined : dialogueOf(dialogue);
  return question === undefined ? null : <Clock question={question} />;
}

function Clock({ question }: { question: Question }) {
  const left = useSecondsLeft(question);
  if (!question.interrupts) return <span class="queue-left">{t("It does not wait")}</span>;
  if (left === null) return null;
  return (
    <span class="queue-left">
      <span class="unseen">{t("waits for")} </span>
      {clock(left)}
    </span>
  );
}

function Taken({ by, asked }: { by: string | null; asked: string | null }) {
  if (by === null) {
    if (asked === null) return null;
    return (
      <span class="badge">{asked === helperName.value ? t("You are asked") : t("{asked} is asked", { asked })}</span>
    );
  }
  return <span class="badge">{by === helperName.value ? t("You are on it") : t("{by} is on it", { by })}</span>;
}
