// The file that is to be a model: under which name, and why the service does not take it.
import { useEffect, useId, useRef, useState } from "preact/hooks";
import type { ModelView } from "../wire/types";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";
import { keepModel } from "./model_calls";
import { isName, type ModelFile } from "./model_file";

interface GiveModelProps {
  given: ModelFile;
  models: readonly ModelView[];
  /** Names that robots say and that nobody has given a model for. */
  missing: readonly string[];
  onKept: () => void;
  onCancel: () => void;
}

export function GiveModel({ given, models, missing, onKept, onCancel }: GiveModelProps) {
  const [name, setName] = useState(missing[0] ?? given.name);
  const [busy, setBusy] = useState(false);
  const [mistake, setMistake] = useState("");
  const field = useRef<HTMLInputElement>(null);
  const id = useId();
  useEffect(() => field.current?.focus(), []);
  const keep = async (event: Event) => {
    event.preventDefault();
    setMistake(isName(name) ? "" : t("A model's name has no “/”, and is more than dots."));
    if (!isName(name)) return;
    setBusy(true);
    try {
      await keepModel(name, given);
      onKept();
    } catch (error) {
      setMistake(whyNotDone(error));
    } finally {
      setBusy(false);
    }
  };
  const replaces = models.some((each) => each.name === name && !each.built_in);
  return (
    <form class="panel give-model" aria-labelledby={`${id}-title`} onSubmit={(event) => void keep(event)}>
      <h2 id={`${id}-title`}>{t("Give {file} as a model", { file: given.file.name })}</h2>
      <div class="field">
        <label for={`${id}-name`}>{t("Name, as robots say it")}</label>
        <input
          id={`${id}-name`}
          ref={field}
          value={name}
          required
          maxLength={128}
          autoComplete="off"
          list={`${id}-names`}
          aria-describedby={`${id}-note`}
          onInput={(event) => setName(event.currentTarget.value)}
        />
      </div>
      <datalist id={`${id}-names`}>
        {[...missing, ...models.filter((each) => !each.built_in).map((each) => each.name)].map((each) => (
          <option key={each} value={each} />
        ))}
      </datalist>
      <p class="small quiet" id={`${id}-note`}>
        {replaces ? t("It takes the place of the one that is there.") : t("Its robots are drawn so at once.")}
      </p>
      <p class="mistake" role="alert">
        {mistake}
      </p>
      <div class="page-actions">
        <button class="button" type="button" onClick={onCancel}>
          {t("Cancel")}
        </button>
        <button class="button primary" type="submit" disabled={busy}>
          {busy ? t("Being checked …") : t("Keep it as a model")}
        </button>
      </div>
    </form>
  );
}
