// What a helper can set on this device.
import { useState } from "preact/hooks";
import { principal } from "../state/access";
import { helperName, type Theme, theme } from "../state/preferences";
import { call, signOut, tokenRequired } from "../state/service";
import { AnswerKeys } from "./answer_keys";
import { LanguageChoice } from "./language_choice";
import { Calling } from "./calling";
import { VoiceChoice } from "./voice_choice";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";
import "./settings.css";

const THEMES: readonly (readonly [Theme, string])[] = [
  ["system", t("As the device")],
  ["light", t("Light")],
  ["dark", t("Dark")],
];

export function SettingsView() {
  const rename = (event: Event) => {
    const name = (event.currentTarget as HTMLInputElement).value.trim();
    if (name !== "") void call(name);
  };
  return (
    <section class="page settings">
      <h1>{t("Settings")}</h1>
      <p class="quiet">{t("They are kept on this device.")}</p>
      <div class="panel field">
        <label for="helper-name">{t("Your name")}</label>
        <input
          id="helper-name"
          value={helperName.value}
          maxlength={64}
          readOnly={principal.value !== null}
          onChange={rename}
          aria-describedby="helper-name-hint"
        />
        <p id="helper-name-hint" class="small quiet">
          {principal.value === null
            ? t("The robots and the other helpers see who answered.")
            : t("It goes with your token.")}
        </p>
      </div>
      <LanguageChoice />
      <AnswerKeys />
      <Calling />
      <VoiceChoice />
      <fieldset class="panel setting-group">
        <legend>{t("Colours")}</legend>
        <div class="choices">
          {THEMES.map(([value, text]) => (
            <label key={value} class="choice">
              <input
                type="radio"
                name="theme"
                checked={theme.value === value}
                onChange={() => {
                  theme.value = value;
                }}
              />
              {text}
            </label>
          ))}
        </div>
      </fieldset>
      {tokenRequired.value && <SignOut />}
    </section>
  );
}

function SignOut() {
  const [mistake, setMistake] = useState<string | null>(null);
  const leave = () => {
    setMistake(null);
    signOut().catch((error: Error) => setMistake(whyNotDone(error)));
  };
  return (
    <>
      <p>
        <button class="button" type="button" onClick={leave}>
          {t("Sign out")}
        </button>
      </p>
      {mistake !== null && (
        <p class="mistake" role="alert">
          {mistake}
        </p>
      )}
    </>
  );
}
