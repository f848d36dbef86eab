// Who is on a question, for everybody to see.
import { may } from "../state/access";
import { helperName } from "../state/preferences";
import type { Question } from "../state/questions";
import { isPutOff, putOffCalls, takeCallsAgain } from "../calling/calls";
import { claim, release } from "./claiming";
import { askedNow } from "./turn";
import { t } from "../words/words";
import "./claim_strip.css";

export function ClaimStrip({ question }: { question: Question }) {
  const { claimed_by: by, dialogue } = question;
  if (by === null) return <NobodyOnIt question={question} />;
  const mine = by === helperName.value;
  return (
    <div class={`claim ${mine ? "mine" : "others"}`}>
      <p>
        <span class="who-dot" aria-hidden="true">
          {by.slice(0, 1).toUpperCase()}
        </span>
        {mine ? t("You are on it.") : t("{by} is answering.", { by })}
      </p>
      {mine && (
        <button type="button" class="button" onClick={() => release(dialogue)}>
          {t("Let go")}
        </button>
      )}
      {!mine && may("helper") && (
        <button type="button" class="button" onClick={() => void claim(dialogue, true)}>
          {t("Take over")}
        </button>
      )}
    </div>
  );
}

function NobodyOnIt({ question }: { question: Question }) {
  const asked = askedNow(question);
  const others = asked !== null && asked !== helperName.value;
  const off = isPutOff(question);
  const turn =
    asked === null
      ? t("Nobody is on it yet.")
      : others
        ? t("{asked} is asked now.", { asked })
        : t("You are asked now.");
  const who = off ? t("You are not called about it here.") : turn;
  return (
    <div class={`claim ${others ? "others" : ""}`}>
      <p class={others ? undefined : "quiet"}>{who}</p>
      {may("helper") && (
        <div class="claim-buttons">
          {!others && (
            <button type="button" class="button" onClick={() => (off ? takeCallsAgain : putOffCalls)(question)}>
              {off ? t("Call me again") : t("Not me")}
            </button>
          )}
          <button type="button" class="button" onClick={() => void claim(question.dialogue, false)}>
            {others ? t("Take it") : t("I am on it")}
          </button>
        </div>
      )}
    </div>
  );
}
