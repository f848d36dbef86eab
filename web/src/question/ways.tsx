// Every way of help that the robot would ask for one after the other, at once; the most wanted first.
import { keysOn } from "../state/preferences";
import type { Question } from "../state/questions";
import type { WayOption } from "../wire/types";
import { isHeld, quoted } from "./answering";
import { AnsweringNote } from "./answering_note";
import type { Arming } from "./arming";
import { HeldBack } from "./held_back";
import { takesAnswers } from "./takes_answers";
import { t } from "../words/words";
import { Told } from "../words/told";
import "./ways.css";

interface WaysProps {
  question: Question;
  arming: Arming;
  onChoose(way: string): void;
}

export function Ways({ question, arming, onChoose }: WaysProps) {
  const { prompt, dialogue } = question;
  if (prompt === null) return null;
  const closed = !takesAnswers(question, arming);
  return (
    <div class="answering">
      <div class="ways" role="group" aria-label={t("What you can do")}>
        {prompt.ways.map((each, index) => (
          <button
            key={each.way}
            type="button"
            class={`way ${helps(each) ? "" : "not-now"} ${isHeld(prompt.prompt, quoted(each.label)) ? "held" : ""}`}
            aria-disabled={closed}
            aria-describedby={effectOf(dialogue, each)}
            aria-keyshortcuts={keysOn.value ? String(index + 1) : undefined}
            onClick={() => onChoose(each.way)}
          >
            <Told text={each.label} />
            {keysOn.value && <kbd aria-hidden="true">{index + 1}</kbd>}
          </button>
        ))}
        <HeldBack prompt={prompt.prompt} />
      </div>
      <AnsweringNote question={question} arming={arming} />
    </div>
  );
}

/** What each of them will do. */
export function WayEffects({ question: { prompt, dialogue } }: { question: Question }) {
  if (prompt === null) return null;
  return (
    <dl class="way-effects" aria-label={t("What each does")}>
      {prompt.ways.map((each) => (
        <div key={each.way}>
          <dt><Told text={each.label} /></dt>
          <dd id={effectOf(dialogue, each)}><Told text={each.effect} /></dd>
        </div>
      ))}
      {prompt.timeout_effect !== "" && (
        <div>
          <dt>{t("Without an answer")}</dt>
          <dd><Told text={prompt.timeout_effect} /></dd>
        </div>
      )}
    </dl>
  );
}

const helps = ({ answers }: WayOption) => answers.includes("yes");

const effectOf = (dialogue: string, { way }: WayOption) => `does-${dialogue}-${way}`;
