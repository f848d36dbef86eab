// One question: what there is to do, every way of it as a button, and beneath what each does and why it is asked.
import { useEffect } from "preact/hooks";
import type { Question } from "../state/questions";
import { connection, runs } from "../state/service";
import { type Answer, answer, choose } from "./answering";
import { Answers } from "./answers";
import { useAnswerKeys } from "./answer_keys";
import { useArming } from "./arming";
import { AskingPlace } from "./asking_place";
import { ClaimStrip } from "./claim_strip";
import { actOn, release } from "./claiming";
import { Countdown, MoreTime } from "./countdown";
import { WhatWasSeen } from "./fault_picture";
import { faultInWords, robotName, spoken } from "./fault_words";
import { PausedNode } from "./paused_node";
import { SpeechControls } from "./speech_controls";
import { SpokenQuestion } from "./spoken_question";
import { WayEffects, Ways } from "./ways";
import { t } from "../words/words";
import { Told } from "../words/told";
import "./question_card.css";

interface QuestionCardProps {
  question: Question;
  /** Beside the run's own drawing of the tree, which shows the paused node already. */
  besideTree?: boolean;
}

export function QuestionCard({ question, besideTree = false }: QuestionCardProps) {
  const { prompt } = question;
  const arming = useArming(prompt?.prompt ?? null);
  const whenArmed = (reply: () => void) => {
    if (connection.peek() !== "connected") return;
    if (arming.armed) reply();
    else arming.noteTooEarly();
  };
  const give = (value: Answer) => whenArmed(() => answer(question, value));
  const chooseWay = (way: string) => whenArmed(() => choose(question, way));
  useAnswerKeys(question, give, chooseWay);
  useEffect(() => () => release(question.dialogue), [question.dialogue]);
  if (prompt === null) return null;
  const act = () => actOn(question);
  const run = runs.value.get(question.run);
  const titled = `question-${question.dialogue}`;
  const withWays = prompt.ways.length > 0;
  return (
    <article class={`question panel ${withWays ? "with-ways" : ""}`} aria-labelledby={titled}>
      <header class="question-head">
        <p class="question-about">
          <strong>{robotName(question.robot)}</strong>
        </p>
        <Countdown question={question} />
      </header>
      <h2 id={titled} class="question-text">
        <Told text={withWays ? prompt.headline : prompt.text} />
      </h2>
      <div class="question-answers" onPointerMove={act} onPointerDown={act} onFocusCapture={act}>
        {withWays ? (
          <Ways question={question} arming={arming} onChoose={chooseWay} />
        ) : (
          <Answers question={question} arming={arming} onAnswer={give} />
        )}
      </div>
      <div class="question-body">
        <div class="question-seen" onPointerDown={act} onKeyDown={act}>
          <WhatWasSeen question={question} />
          <p class="question-fault">{faultInWords(question)}</p>
          <AskingPlace question={question} />
        </div>
        <div class="question-more">
          {withWays && <WayEffects question={question} />}
          <MoreTime question={question} />
          {withWays && <SpokenQuestion question={question} arming={arming} onAct={act} onAnswer={give} />}
          {prompt.version > 1 && (
            <p class="quiet small">{t("Asked for the {nth} time.", { nth: ordinal(prompt.version) })}</p>
          )}
          <SpeechControls question={question} onAct={act} />
          <ClaimStrip question={question} />
          <p class="question-about quiet">
            {run !== undefined && <a href={`/runs/${question.run}`}>{spoken(run.tree)}</a>}{" "}
            {t("at “{name}”", { name: spoken(question.name) })}
          </p>
          {!besideTree && <PausedNode run={question.run} node={question.node} name={question.name} />}
        </div>
      </div>
    </article>
  );
}

function ordinal(count: number): string {
  if (Math.floor(count / 10) % 10 === 1) return t("{count}th", { count });
  switch (count % 10) {
    case 1:
      return t("{count}st", { count });
    case 2:
      return t("{count}nd", { count });
    case 3:
      return t("{count}rd", { count });
    default:
      return t("{count}th", { count });
  }
}
