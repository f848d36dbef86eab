// What the robot and a helper are talking about at the moment that is shown.
import { plain } from "../tree/words";
import { picturePath } from "../wire/rest";
import { awaiting, type OpenDialogue } from "./fold";
import "./dialogue_now.css";

export function DialogueNow({ dialogue }: { dialogue: OpenDialogue }) {
  const { opened, raised, prompt, answered, claimedBy } = dialogue;
  return (
    <article class="panel dialogue-now" aria-label={`Dialogue about ${plain(opened.object ?? opened.name)}`}>
      {raised?.picture != null && <img src={picturePath(raised.picture)} alt="What the robot saw at the fault" />}
      <div>
        <p class="small quiet">
          {opened.robot} · {plain(opened.issue)} · {plain(opened.object ?? opened.name)}
        </p>
        {prompt !== null && <p class="dialogue-text">“{prompt.text}”</p>}
        <p class="small">
          {STATE[awaiting(dialogue) ?? "none"]}
          {answered !== null && ` ${answered.helper} answered ${answered.answer}.`}
          {claimedBy !== null && ` ${claimedBy} is on it.`}
        </p>
      </div>
    </article>
  );
}

const STATE = {
  answer: "The robot waits for an answer.",
  help: "The robot watches for the promised help.",
  none: "The robot goes on.",
} as const;
