// What the robot asks aloud, to be answered with yes or no: by voice, by key, or here.
import { keys, keysOn } from "../state/preferences";
import type { Question } from "../state/questions";
import { type Answer, WORDS } from "./answering";
import { AnswerKey } from "./answers";
import type { Arming } from "./arming";
import { takesAnswers } from "./takes_answers";
import { t } from "../words/words";
import { said } from "../words/said";
import { Told } from "../words/told";

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
      <h3><Told text={prompt.text} /></h3>
      <div class="spoken-answers" role="group" aria-label={t("Yes or no")} onPointerMove={onAct} onFocusCapture={onAct}>
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
        {t("{yes} is “{label}”. {no}: {effect}", {
          yes: WORDS.yes,
          label: said(first.label),
          no: WORDS.no,
          effect: said(no?.effect ?? ""),
        })}
      </p>
    </section>
  );
}
