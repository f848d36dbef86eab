// Which language this page speaks on this device.
import { CHOSEN_AS, language, languages, nameOf } from "../words/language";
import { t } from "../words/words";

export function LanguageChoice() {
  const choose = (chosen: string) => {
    localStorage.setItem(CHOSEN_AS, JSON.stringify(chosen));
    // What stands in the modules was said as they were loaded.
    location.reload();
  };
  return (
    <fieldset class="panel setting-group">
      <legend>{t("Language")}</legend>
      <div class="choices">
        {languages.map((each) => (
          <label key={each} class="choice" lang={each}>
            <input type="radio" name="language" checked={each === language} onChange={() => choose(each)} />
            {nameOf(each)}
          </label>
        ))}
      </div>
      {language !== "en" && (
        <p class="small quiet">
          {t("What is spoken is understood in English only, unless whoever runs the service has set another model. What robots say in words of their own stays English too.")}
        </p>
      )}
    </fieldset>
  );
}
