// What the robots ask: one question large, the others in a queue, and what help is awaited; below it all that goes on.
import { useEffect } from "preact/hooks";
import { awaitingHelp, together } from "../state/questions";
import { runs } from "../state/service";
import type { RunStatus } from "../wire/types";
import { Endings } from "./endings_list";
import { QuestionCard } from "./question_card";
import { queue, shown, stopChoosing } from "./queue";
import { later } from "../app/later";
import { loadOtherWords } from "../words/load";
import { AwaitedHelpCard, TogetherCard } from "./waiting_cards";
import { AtAGlance } from "./at_a_glance";
import { t } from "../words/words";
import "./questions_view.css";

// Whoever has one question before them needs no list.
const QueueList = later(
  () => import("./queue_list").then((module) => module.QueueList),
  () => Promise.resolve(),
);

const GOING: ReadonlySet<RunStatus> = new Set<RunStatus>(["running", "paused"]);

// Few runs are steered.
const RunWaits = later(() => import("../run/steering/run_waits").then((module) => module.RunWaits));

// Whom robots ask besides is no part of answering.
const WhoHelps = later(() => import("./who_helps").then((module) => module.WhoHelps), loadOtherWords, true);

const Overview = later(() => import("../home/overview").then((module) => module.Overview), loadOtherWords, true);

export function QuestionsView() {
  useEffect(() => stopChoosing, []);
  const question = shown.value;
  const held = [...runs.value.values()].filter(({ status, waits }) => GOING.has(status) && waits.length > 0);
  const waiting = awaitingHelp.value.length + together.value.length > 0;
  const beside = queue.value.length > 1 || (question !== null && waiting);
  return (
    <section class={`page questions ${beside ? "with-side" : ""}`}>
      <h1 class="unseen">{t("Questions")}</h1>
      <Endings />
      <div class="questions-main">
        {held.map((each) => <RunWaits key={each.id} run={each.id} tree={each.tree} waits={each.waits} going />)}
        {question !== null && <QuestionCard key={question.dialogue} question={question} />}
        {question === null && waiting && <Waiting />}
        {question === null && !waiting && <AtAGlance />}
        <WhoHelps />
        <Overview asked={question !== null || waiting} />
      </div>
      {beside && (
        <aside class="questions-side" aria-label={t("Also going on")}>
          {queue.value.length > 1 && <QueueList shown={question} />}
          {waiting && <Waiting />}
        </aside>
      )}
    </section>
  );
}

function Waiting() {
  return (
    <div class="waiting-list">
      {awaitingHelp.value.map((each) => (
        <AwaitedHelpCard key={each.dialogue} question={each} />
      ))}
      {together.value.map((each) => (
        <TogetherCard key={each.dialogue} together={each} />
      ))}
    </div>
  );
}
