// The two things that there are to say while help is awaited.
import { helperName } from "../state/preferences";
import type { Question } from "../state/questions";
import { connection } from "../state/service";
import { listensTo, type SpeechPhase, speechPhase } from "../speech/speech_state";
import { shown } from "./queue";
import { maySayDone, mayTakeBack, onItsWay, say, wordMistakes } from "./promise";
import { t } from "../words/words";

const SPOKEN: Partial<Record<SpeechPhase, string>> = {
  listening: t("Speak now: “done”, or “I can’t”"),
  hearing: t("Listening to you …"),
};

function spokenHint(): string | undefined {
  if (speechPhase.value !== "listening" || listensTo.value === null) return SPOKEN[speechPhase.value];
  return t("Speak now, in {language}: “{done}” or “{cannot}”", listensTo.value);
}

export function PromiseButtons({ question }: { question: Question }) {
  const { dialogue, help } = question;
  if (help === null) return null;
  const looks = help.reported_by !== null;
  const offline = connection.value !== "connected";
  const busy = onItsWay.value?.dialogue === dialogue;
  const mistake = wordMistakes.value.get(dialogue);
  return (
    <div class="promise">
      {maySayDone(question) && (
        <button
          type="button"
          class="button primary"
          aria-disabled={looks || busy || offline}
          onClick={() => say(question, "done")}
        >{t("Done, look again")}</button>
      )}
      {mayTakeBack(question) && (
        <button type="button" class="button" aria-disabled={busy || offline} onClick={() => say(question, "take_back")}>{t("I can’t after all")}</button>
      )}
      <p class="promise-note small" role="status">
        {looks &&
          (help.reported_by === helperName.value
            ? t("You said that it is done. The robot looks …")
            : t("{helper} said that it is done. The robot looks …", { helper: help.reported_by ?? "" }))}
        {!looks && !offline && mistake === undefined && shown.value === null && spokenHint()}
        {offline && t("No connection to the service. You can say so as soon as it is back.")}
        {mistake !== undefined && !looks && !offline && <span class="mistake">{mistake}</span>}
      </p>
    </div>
  );
}
