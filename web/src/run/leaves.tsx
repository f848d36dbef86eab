// Leaves that people do themselves: taking one, saying so in words, and giving it back.
import { useState } from "preact/hooks";
import { SpeakButton } from "../speech/speak_button";
import { may, whyNot } from "../state/access";
import { helperName } from "../state/preferences";
import { plain } from "../tree/words";
import * as rest from "../wire/rest";
import type { NodeTaken, NodeView } from "../wire/types";
import { beingDone, canBeTaken, whatWasSaid } from "./leaf_words";
import { sentence } from "./run_words";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";
import "./leaves.css";

interface LeavesProps {
  run: string;
  /** The leaves that people do, by path. */
  people: ReadonlyMap<string, NodeTaken>;
  selected: NodeView | null;
  /** A part of this task, for what can be said of it. */
  example: string;
  /** Whether the run goes on and its newest moment is shown. */
  going: boolean;
}

export function Leaves({ run, people, selected, example, going }: LeavesProps) {
  const me = helperName.value;
  const [note, setNote] = useState({ text: "", refused: false });
  const [busy, setBusy] = useState(false);
  const ask = async (request: Promise<string>): Promise<boolean> => {
    setBusy(true);
    const found = await request.then(
      (text) => ({ text, refused: false }),
      (error: Error) => ({ text: sentence(whyNotDone(error)), refused: true }),
    );
    setNote(found);
    setBusy(false);
    return !found.refused;
  };
  const take = ({ node, name }: NodeView) =>
    ask(rest.takeLeaf(run, node, me).then(() => whatWasSaid({ deed: "take", node, name })));
  const giveBack = ({ node, name }: NodeTaken) =>
    ask(rest.giveLeafBack(run, node, me).then(() => whatWasSaid({ deed: "give_back", node, name })));
  const offered = going && may("helper");
  return (
    <section class="panel leaves" aria-labelledby="leaves-title">
      <h2 id="leaves-title">{t("What people do themselves")}</h2>
      {[...people.values()].map((taken) => (
        <div key={taken.node} class="leaf-taken">
          <p class="small">{beingDone(taken, me)}</p>
          {offered && taken.helper === me && (
            <button type="button" class="button" disabled={busy} onClick={() => void giveBack(taken)}>
              {t("Give it back")}
            </button>
          )}
        </div>
      ))}
      {offered && selected !== null && canBeTaken(selected) && (
        <button type="button" class="button" disabled={busy} onClick={() => void take(selected)}>
          {t("I do this: {name}", { name: plain(selected.name) })}
        </button>
      )}
      {offered && <Words busy={busy} example={example} say={(words) => ask(rest.sayOfLeaf(run, words, me).then(whatWasSaid))} />}
      {going && !may("helper") && <p class="quiet small">{whyNot(t("Doing a part of it"), "helper")}</p>}
      <p role="status" class={note.refused ? "mistake small" : "small"}>
        {note.text}
      </p>
    </section>
  );
}

/** Resolves with whether it was done. */
function Words({ busy, example, say }: { busy: boolean; example: string; say(words: string): Promise<boolean> }) {
  const [words, setWords] = useState("");
  const tell = async (told: string) => {
    // What is being typed by then is something else.
    if (await say(told)) setWords((now) => (now === told ? "" : now));
  };
  return (
    <form
      class="leaf-words"
      onSubmit={(event) => {
        event.preventDefault();
        void tell(words);
      }}
    >
      <label class="small" for="leaf-words">
        {t("Choose a leaf that waits, or say it: “I do the {example}”, “I give the {example} back”", { example })}
      </label>
      <div>
        <input
          id="leaf-words"
          class="input"
          autocomplete="off"
          maxLength={200}
          value={words}
          onInput={(event) => setWords(event.currentTarget.value)}
        />
        <button class="button" disabled={busy || words.trim() === ""}>
          {t("Say it")}
        </button>
        <SpeakButton
          label={t("Speak")}
          heard={(said) => {
            setWords(said);
            void tell(said);
          }}
        />
      </div>
    </form>
  );
}
