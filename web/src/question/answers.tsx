// The two answers, large, each with what it will do; and the one that is held back for a moment.
import { may, whyNot } from "../state/access";
import { keys, keysOn } from "../state/preferences";
import type { Question } from "../state/questions";
import { connection } from "../state/service";
import { type Answer, given, held, mistakes, undo } from "./answering";
import type { Arming } from "./arming";
import "./answers.css";

const WORDS = { yes: "YES", no: "NO" } as const;

interface AnswersProps {
  question: Question;
  arming: Arming;
  onAnswer(value: Answer): void;
}

export function Answers({ question, arming: { armed, tooEarly }, onAnswer }: AnswersProps) {
  const { prompt } = question;
  if (prompt === null) return null;
  const waiting = held.value?.prompt === prompt.prompt ? held.value : null;
  const busy = given.value.has(prompt.prompt) || question.awaiting !== "answer";
  const offline = connection.value !== "connected";
  const allowed = may("helper");
  const closed = !armed || busy || offline || !allowed;
  const mistake = mistakes.value.get(prompt.prompt);
  return (
    <div class="answering">
      <div class="answers" role="group" aria-label="Your answer">
        {prompt.answers.map(({ value, effect }) => (
          <button
            key={value}
            type="button"
            class={`answer ${value} ${waiting?.answer === value ? "held" : ""}`}
            aria-disabled={closed}
            aria-keyshortcuts={keysOn.value ? keys.value[value] : undefined}
            onClick={() => onAnswer(value)}
          >
            <span class="answer-word">
              {WORDS[value]}
              {keysOn.value && keys.value[value] !== "" && (
                <kbd aria-hidden="true">{keys.value[value].toUpperCase()}</kbd>
              )}
            </span>
            <span class="answer-effect">{effect}</span>
          </button>
        ))}
        {waiting !== null && (
          <div class="held-back">
            <p>
              <strong>{WORDS[waiting.answer]}</strong> is sent in a moment
            </p>
            <button type="button" class="button" onClick={undo}>
              Undo <kbd aria-hidden="true">Esc</kbd>
            </button>
            <span class="held-progress" aria-hidden="true" />
          </div>
        )}
      </div>
      {prompt.timeout_effect !== "" && <p class="answer-timeout">Without an answer: {prompt.timeout_effect}</p>}
      <p class="answering-note" role="status">
        {waiting !== null && <span class="unseen">Your {WORDS[waiting.answer]} is sent in 3 seconds. Escape takes it back.</span>}
        {!allowed && whyNot("Answering", "helper")}
        {offline && "No connection to the service. You can answer as soon as it is back."}
        {mistake !== undefined && <span class="mistake">{mistake}</span>}
        {busy && !offline && "Sent."}
        {tooEarly && !busy && !offline && allowed && <strong>This question has only just come. Read it, then answer again.</strong>}
      </p>
    </div>
  );
}
