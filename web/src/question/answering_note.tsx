// What became of a reply, or why there can be none now.
import { may, whyNot } from "../state/access";
import type { Question } from "../state/questions";
import { connection } from "../state/service";
import { held, mistakes } from "./answering";
import type { Arming } from "./arming";
import { isAnswered } from "./takes_answers";
import { t } from "../words/words";

export function AnsweringNote({ question, arming: { tooEarly } }: { question: Question; arming: Arming }) {
  const prompt = question.prompt?.prompt ?? "";
  const waiting = held.value?.prompt === prompt ? held.value : null;
  const busy = isAnswered(question);
  const offline = connection.value !== "connected";
  const allowed = may("helper");
  const mistake = mistakes.value.get(prompt);
  return (
    <p class="answering-note" role="status">
      {waiting !== null && (
        <span class="unseen">{t("Your {reply} is sent in 3 seconds. Escape takes it back.", { reply: waiting.said })}</span>
      )}
      {!allowed && whyNot(t("Answering"), "helper")}
      {offline && t("No connection to the service. You can answer as soon as it is back.")}
      {mistake !== undefined && <span class="mistake">{mistake}</span>}
      {busy && !offline && t("Sent.")}
      {tooEarly && !busy && !offline && allowed && (
        <strong>{t("This question has only just come. Read it, then answer again.")}</strong>
      )}
    </p>
  );
}
