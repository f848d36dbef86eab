// What the robot and a helper are talking about at the moment that is shown.
import { plain } from "../tree/words";
import { picturePath } from "../wire/rest";
import { awaiting, type OpenDialogue } from "./fold";
import { issueKind } from "../words/issue_kinds";
import { t } from "../words/words";
import "./dialogue_now.css";
import { learn } from "../words/said";
import { Quoted } from "../words/told";

export function DialogueNow({ dialogue }: { dialogue: OpenDialogue }) {
  const { opened, raised, prompt, answered, claimedBy } = dialogue;
  if (prompt !== null) learn(prompt.wordings);
  return (
    <article
      class="panel dialogue-now"
      aria-label={t("Dialogue about {part}", { part: plain(opened.object ?? opened.name) })}
    >
      {raised?.picture != null && <img src={picturePath(raised.picture)} alt={t("What the robot saw at the fault")} />}
      <div>
        <p class="small quiet">
          {opened.robot} · {issueKind(opened.issue)} · {plain(opened.object ?? opened.name)}
        </p>
        {prompt !== null && <p class="dialogue-text"><Quoted text={prompt.text} /></p>}
        <p class="small">
          {STATE[awaiting(dialogue) ?? "none"]}
          {answered !== null &&
            ` ${t("{helper} answered {answer}.", { helper: answered.helper, answer: answered.answer === "yes" ? t("yes") : t("no") })}`}
          {claimedBy !== null && ` ${t("{by} is on it.", { by: claimedBy })}`}
        </p>
      </div>
    </article>
  );
}

const STATE = {
  answer: t("The robot waits for an answer."),
  help: t("The robot watches for the promised help."),
  none: t("The robot goes on."),
} as const;
