// The single keys that answer: changed, or switched off, as whoever dictates or types needs it.
import { useState } from "preact/hooks";
import { DEFAULT_KEYS, type Keys, keys, keysOn } from "../state/preferences";
import { t } from "../words/words";

const NAMES: readonly (readonly [keyof Keys, string])[] = [
  ["yes", t("Yes")],
  ["no", t("No")],
  ["repeat", t("Repeat the question")],
];

export function AnswerKeys() {
  const [mistake, setMistake] = useState("");
  const change = (which: keyof Keys, input: HTMLInputElement) => {
    const key = input.value.trim().toLowerCase();
    const taken = NAMES.find(([other]) => other !== which && key !== "" && keys.value[other] === key);
    setMistake(
      taken === undefined
        ? ""
        : t("“{key}” is the key for “{taken}” already.", { key: key.toUpperCase(), taken: taken[1] }),
    );
    if (taken === undefined) keys.value = { ...keys.value, [which]: key };
    else input.value = keys.value[which];
  };
  return (
    <fieldset class="panel setting-group">
      <legend>{t("Keys for answering")}</legend>
      <label class="choice">
        <input
          type="checkbox"
          checked={keysOn.value}
          onChange={(event) => {
            keysOn.value = event.currentTarget.checked;
          }}
        />
        {t("Answer with single keys")}
      </label>
      <div class="key-fields">
        {NAMES.map(([which, text]) => (
          <div key={which} class="field">
            <label for={`key-${which}`}>{text}</label>
            <input
              id={`key-${which}`}
              class="key-field"
              value={keys.value[which]}
              maxlength={1}
              autocomplete="off"
              disabled={!keysOn.value}
              aria-describedby="keys-hint keys-mistake"
              onFocus={(event) => event.currentTarget.select()}
              onChange={(event) => change(which, event.currentTarget)}
            />
          </div>
        ))}
      </div>
      <p id="keys-hint" class="small quiet">
        {t("Leave a field empty to switch one key off. Escape always takes an answer back while it still can be.")}
      </p>
      <p id="keys-mistake" class="mistake" role="status">
        {mistake}
      </p>
      <p>
        <button
          type="button"
          class="button"
          onClick={() => {
            keys.value = DEFAULT_KEYS;
            setMistake("");
          }}
        >
          {t("Back to Y, N and R")}
        </button>
      </p>
    </fieldset>
  );
}
