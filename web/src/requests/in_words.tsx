// Asking in words: what was understood is read back, and asked for once somebody has said yes.
import { useId, useState } from "preact/hooks";
import * as rest from "../wire/rest";
import { SpeakButton } from "../speech/speak_button";
import type { RequestDocument } from "./use_asking";
import { timeOf } from "./when";
import { t } from "../words/words";
import { Told } from "../words/told";

interface InWordsProps {
  site: string;
  /** At whose touch screen; null anywhere else. */
  robot: string | null;
  example: string;
  /** What is typed, which is kept elsewhere: until it is booked nobody is to type it again. */
  words: string;
  typed: (words: string) => void;
  /** Both from the service: what it has understood, and how it reads that back. */
  understood: (request: RequestDocument, readBack: string) => void;
}

const LONGEST = 500;

export function InWords({ site, robot, example, words, typed, understood }: InWordsProps) {
  const id = useId();
  const [question, setQuestion] = useState("");
  const [busy, setBusy] = useState(false);
  const say = async (said: string) => {
    if (said.trim() === "") return;
    setBusy(true);
    try {
      const found = await rest.understandRequest(site, said, robot, timeOf(new Date()));
      setQuestion(found.question ?? "");
      if (found.request !== null && found.read_back !== null) understood(found.request, found.read_back);
    } catch (error) {
      setQuestion(error instanceof Error ? error.message : String(error));
    } finally {
      setBusy(false);
    }
  };
  return (
    <form
      class="in-words"
      onSubmit={(event) => {
        event.preventDefault();
        void say(words);
      }}
    >
      <label for={id}>{t("Say it in words, such as “{example}”", { example })}</label>
      <div>
        <input
          id={id}
          class="input"
          autocomplete="off"
          maxLength={LONGEST}
          value={words}
          onInput={(event) => typed(event.currentTarget.value)}
        />
        <button class="button" disabled={busy || words.trim() === ""}>
          {t("Say it")}
        </button>
        <SpeakButton
          label={t("Speak")}
          heard={(said) => {
            typed(said);
            void say(said);
          }}
        />
      </div>
      <p class="mistake" role="alert">
        <Told text={question} />
      </p>
    </form>
  );
}
