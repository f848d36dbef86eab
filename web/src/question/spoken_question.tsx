// What the robot asks aloud, to be answered with yes or no: by voice, by key, or here.
import { keys, keysOn } from "../state/preferences";
import type { Question } from "../state/questions";
import type { Answer } from "./answering";
import { AnswerKey, WORDS } from "./answers";
import type { Arming } from "./arming";
import { takesAnswers } from "./takes_answers";

interface SpokenQuestionProps {
  question: Question;
  arming: Arming;
  onAct(): void;
  onAnswer(value: Answer): void;
}

export function SpokenQuestion({ question, arming, onAct, onAnswer }: SpokenQuestionProps) {
  const { prompt } = question;
  const [first] = prompt?.ways ?? [];
  if (prompt === null || first === undefined) return null;
  const closed = !takesAnswers(question, arming);
  const no = prompt.answers.find(({ value }) => value === "no");
  return (
    <section class="spoken-question">
      <h3>{prompt.text}</h3>
      <div class="spoken-answers" role="group" aria-label="Yes or no" onPointerMove={onAct} onFocusCapture={onAct}>
        {prompt.answers.map(({ value }) => (
          <button
            key={value}
            type="button"
            class={`button answer ${value}`}
            aria-disabled={closed}
            aria-keyshortcuts={keysOn.value ? keys.value[value] : undefined}
            onClick={() => onAnswer(value)}
          >
            {WORDS[value]}
            <AnswerKey value={value} />
          </button>
        ))}
      </div>
      <p class="quiet small">
        {WORDS.yes} is “{first.label}”. {WORDS.no}: {no?.effect}
      </p>
    </section>
  );
}
