// Under which name a text is saved, and whether it may take another's place.
import { useState } from "preact/hooks";
import { may, whyNot } from "../state/access";
import { Confirm } from "../app/confirm";
import * as rest from "../wire/rest";
import type { DocumentSummary } from "../wire/types";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";

interface SaveFormProps {
  /** What is saved, in a sentence. */
  said: string;
  document: string | null;
  text: string;
  name: string;
  others: readonly DocumentSummary[];
  save: (text: string, name: string) => Promise<{ name: string }>;
  changed: boolean;
  onName: (name: string) => void;
  onSaved: (name: string) => void;
  onDiscard: () => void;
}

export function SaveForm(props: SaveFormProps) {
  const { said, document, text, name, others, changed, onName, onSaved, onDiscard } = props;
  const [mistake, setMistake] = useState("");
  const [asking, setAsking] = useState<"replace" | "discard" | null>(null);
  const [saving, setSaving] = useState(false);
  const save = async () => {
    setAsking(null);
    setSaving(true);
    try {
      onSaved((await props.save(text, name)).name);
    } catch (error) {
      setMistake(
        error instanceof rest.Refusal && error.errors.length > 1
          ? t("It was not saved: put the mistakes right first.")
          : t("It was not saved: {message}", { message: whyNotDone(error) }),
      );
      setSaving(false);
    }
  };
  const submit = (event: SubmitEvent) => {
    event.preventDefault();
    setMistake("");
    const other = name !== document && others.some((each) => each.name === name && !each.built_in);
    if (other) setAsking("replace");
    else void save();
  };
  return (
    <form class="save-form" onSubmit={submit}>
      <div class="field">
        <label for="save-name">{t("Name")}</label>
        <input
          id="save-name"
          class="mono"
          value={name}
          required
          maxlength={64}
          spellcheck={false}
          autocomplete="off"
          aria-describedby="save-mistake"
          onInput={(event) => onName(event.currentTarget.value)}
        />
      </div>
      <div class="page-actions">
        {changed && (
          <button class="button" type="button" onClick={() => setAsking("discard")}>
            {t("Discard changes")}
          </button>
        )}
        <button class="button primary" type="submit" disabled={saving || !may("operator")}>
          {t("Save")}
        </button>
        {!may("operator") && <p class="quiet">{whyNot(t("Saving"), "operator")}</p>}
      </div>
      <p id="save-mistake" class="mistake" role="alert">
        {mistake}
      </p>
      {asking === "replace" && (
        <Confirm
          title={t("Replace '{name}'?", { name })}
          confirm={t("Replace it")}
          onConfirm={() => void save()}
          onCancel={() => setAsking(null)}
        >
          {t("There is another {kind} of this name. Its file is lost when this one takes its place.", { kind: said })}
        </Confirm>
      )}
      {asking === "discard" && (
        <Confirm
          title={t("Discard your changes?")}
          confirm={t("Discard")}
          cancel={t("Keep editing")}
          onConfirm={onDiscard}
          onCancel={() => setAsking(null)}
        >
          {t("What you have written since it was last saved is lost.")}
        </Confirm>
      )}
    </form>
  );
}
