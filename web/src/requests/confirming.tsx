// What is read back to somebody, who says whether it is right.
import { useEffect, useRef, useState } from "preact/hooks";

import { SpeakButton } from "../speech/speak_button";
import { t } from "../words/words";
import { language, locale } from "../words/language";
import { Told } from "../words/told";
import { ENGLISH } from "../speech/browser_ear";

// What was heard in German counts on a German page alone: an unclear word is never taken for one of another language.
const SAID: Readonly<Record<string, { yes: readonly string[]; no: readonly string[] }>> = {
  en: {
    yes: ["yes", "yes please", "yes that is right", "yes that's right", "that is right", "that's right", "right"],
    no: ["no", "no thank you", "no thanks", "no that is wrong", "no that's wrong", "that is wrong", "wrong"],
  },
  de: {
    yes: ["ja", "ja bitte", "ja das stimmt", "ja genau", "genau", "ja richtig", "richtig"],
    no: ["nein", "nein danke", "nein das stimmt nicht", "das stimmt nicht", "das ist falsch", "nein das ist falsch", "falsch"],
  },
};
const { yes: YES, no: NO } = SAID[language] ?? { yes: [], no: [] };

interface ConfirmingProps {
  readBack: string;
  busy: boolean;
  yes: () => void;
  no: () => void;
}

export function Confirming({ readBack, busy, yes, no }: ConfirmingProps) {
  const heading = useRef<HTMLHeadingElement>(null);
  const [failure, setFailure] = useState("");
  useEffect(() => heading.current?.focus(), [readBack]);
  return (
    <section class="confirming" aria-label={t("Is that right?")}>
      <h2 ref={heading} tabIndex={-1}>
        <Told text={readBack} />
      </h2>
      <div class="confirming-buttons">
        <button class="button primary" type="button" disabled={busy} onClick={yes}>{t("Yes, that is right")}</button>
        <button class="button" type="button" disabled={busy} onClick={no}>{t("No")}</button>
        <SpeakButton
          label={t("Say yes or no")}
          language={language === "en" ? ENGLISH : locale}
          heard={(words) => {
            if (busy) return;
            const said = words.toLowerCase().replace(/[.,!?]/g, "").trim();
            if (YES.includes(said)) yes();
            else if (NO.includes(said)) no();
            else setFailure(t("I have heard “{words}”: say yes or no, or press a button.", { words }));
          }}
        />
      </div>
      <p class="mistake" role="alert">
        {failure}
      </p>
    </section>
  );
}
