// Who says the questions when they are spoken.
import { useEffect, useState } from "preact/hooks";
import { type Voice, voice } from "../state/preferences";
import { browserVoices } from "../speech/browser_voice";
import { t } from "../words/words";
import { language } from "../words/language";

const VOICES: readonly (readonly [Voice, string])[] = [
  ["service", t("The service's voice")],
  ["browser", t("This browser's own voice")],
];

export function VoiceChoice() {
  const own = useOwnVoice();
  return (
    <fieldset class="panel setting-group">
      <legend>{t("Voice of the robots")}</legend>
      <div class="choices">
        {VOICES.map(([value, text]) => (
          <label key={value} class="choice">
            <input
              type="radio"
              name="voice"
              checked={voice.value === value}
              disabled={value === "browser" && !own}
              onChange={() => {
                voice.value = value;
              }}
            />
            {text}
          </label>
        ))}
      </div>
      {language !== "en" && (
        <p class="small quiet">
          {t("The service speaks English: where this browser has a voice of your language, that one speaks.")}
        </p>
      )}
      {!own && <p class="small quiet">{t("This browser has no voice of its own.")}</p>}
    </fieldset>
  );
}

/** Some browsers find their voices only some time after they are first asked for them. */
function useOwnVoice(): boolean {
  const [own, setOwn] = useState(() => browserVoices().length > 0);
  useEffect(() => {
    if (!("speechSynthesis" in window)) return;
    const look = () => setOwn(browserVoices().length > 0);
    speechSynthesis.addEventListener("voiceschanged", look);
    return () => speechSynthesis.removeEventListener("voiceschanged", look);
  }, []);
  return own;
}
