// The two answers, large, each with what it will do: for a question that has no ways of help.
import { keys, keysOn } from "../state/preferences";
import type { Question } from "../state/questions";
import { type Answer, isHeld, WORDS } from "./answering";
import { AnsweringNote } from "./answering_note";
import type { Arming } from "./arming";
import { HeldBack } from "./held_back";
import { takesAnswers } from "./takes_answers";
import { t } from "../words/words";
import { said } from "../words/said";
import { Told } from "../words/told";
import "./answers.css";

interface AnswersProps {
  question: Question;
  arming: Arming;
  onAnswer(value: Answer): void;
}

export function Answers({ question, arming, onAnswer }: AnswersProps) {
  const { prompt } = question;
  if (prompt === null) return null;
  const closed = !takesAnswers(question, arming);
  return (
    <div class="answering">
      <div class="answers" role="group" aria-label={t("Your answer")}>
        {prompt.answers.map(({ value, effect }) => (
          <button
            key={value}
            type="button"
            class={`answer large ${value} ${isHeld(prompt.prompt, WORDS[value]) ? "held" : ""}`}
            aria-disabled={closed}
            aria-keyshortcuts={keysOn.value ? keys.value[value] : undefined}
            onClick={() => onAnswer(value)}
          >
            <span class="answer-word">
              {WORDS[value]}
              <AnswerKey value={value} />
            </span>
            <span class="answer-effect"><Told text={effect} /></span>
          </button>
        ))}
        <HeldBack prompt={prompt.prompt} />
      </div>
      {prompt.timeout_effect !== "" && (
        <p class="answer-timeout">
          {t("Without an answer: {effect}", { effect: said(prompt.timeout_effect) })}
        </p>
      )}
      <AnsweringNote question={question} arming={arming} />
    </div>
  );
}

/** The key that gives this answer, where there is one. */
export function AnswerKey({ value }: { value: Answer }) {
  if (!keysOn.value || keys.value[value] === "") return null;
  return <kbd aria-hidden="true">{keys.value[value].toUpperCase()}</kbd>;
}
