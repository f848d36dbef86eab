// One question: what went wrong, what the robot saw, and the two answers with what each will do.
import { useEffect } from "preact/hooks";
import type { Question } from "../state/questions";
import { connection, runs } from "../state/service";
import { type Answer, answer } from "./answering";
import { Answers } from "./answers";
import { useAnswerKeys } from "./answer_keys";
import { useArming } from "./arming";
import { AskingPlace } from "./asking_place";
import { ClaimStrip } from "./claim_strip";
import { actOn, release } from "./claiming";
import { Countdown } from "./countdown";
import { WhatWasSeen } from "./fault_picture";
import { faultInWords, robotName, spoken } from "./fault_words";
import { PausedNode } from "./paused_node";
import { SpeechControls } from "./speech_controls";
import "./question_card.css";

interface QuestionCardProps {
  question: Question;
  /** Beside the run's own drawing of the tree, which shows the paused node already. */
  besideTree?: boolean;
}

export function QuestionCard({ question, besideTree = false }: QuestionCardProps) {
  const { prompt } = question;
  const arming = useArming(prompt?.prompt ?? null);
  const give = (value: Answer) => {
    if (connection.peek() !== "connected") return;
    if (arming.armed) answer(question, value);
    else arming.noteTooEarly();
  };
  useAnswerKeys(question, give);
  useEffect(() => () => release(question.dialogue), [question.dialogue]);
  if (prompt === null) return null;
  const act = () => actOn(question);
  const run = runs.value.get(question.run);
  const titled = `question-${question.dialogue}`;
  return (
    <article class="question panel" aria-labelledby={titled}>
      <header class="question-head">
        <p class="question-about">
          <strong>{robotName(question.robot)}</strong>
          {run !== undefined && <a href={`/runs/${question.run}`}>{spoken(run.tree)}</a>}
          <span class="quiet">at “{spoken(question.name)}”</span>
        </p>
        <Countdown question={question} />
      </header>
      <div class="question-words">
        <p class="question-fault">{faultInWords(question)}</p>
        <h2 id={titled} class="question-text">
          {prompt.text}
        </h2>
        {prompt.version > 1 && <p class="quiet small">Asked for the {ordinal(prompt.version)} time.</p>}
      </div>
      <div class="question-body">
        <div class="question-seen" onPointerDown={act} onKeyDown={act}>
          <WhatWasSeen question={question} />
          <AskingPlace question={question} />
        </div>
        <div class="question-answers" onPointerMove={act} onPointerDown={act} onFocusCapture={act}>
          <Answers question={question} arming={arming} onAnswer={give} />
        </div>
        <div class="question-more">
          <SpeechControls question={question} onAct={act} />
          <ClaimStrip question={question} />
          {!besideTree && <PausedNode run={question.run} node={question.node} name={question.name} />}
        </div>
      </div>
    </article>
  );
}

function ordinal(count: number): string {
  const ending = { 1: "st", 2: "nd", 3: "rd" }[count % 10];
  return `${count}${Math.floor(count / 10) % 10 === 1 || ending === undefined ? "th" : ending}`;
}
