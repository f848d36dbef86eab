// What a new part, or a new place, is to be: its name, and of a part how large and of which colour.
import { useEffect, useRef, useState } from "preact/hooks";
import { linearColor, screenColor } from "./colors";
import { NAME_PATTERN } from "./new_thing";
import { SizeFields } from "./size_fields";
import { t } from "../words/words";

export type Wanted = { name: string } & ({ kind: "object"; size: readonly number[]; color: readonly number[] } | { kind: "place" });

interface AddFormProps {
  kind: Wanted["kind"];
  /** A name that is free. */
  name: string;
  onAdd: (wanted: Wanted) => void;
  onCancel: () => void;
}

const SIZE = [0.04, 0.06, 0.05];
const COLOR = [0.1, 0.3, 0.8];

export function AddForm({ kind, name: free, onAdd, onCancel }: AddFormProps) {
  const [name, setName] = useState(free);
  const [size, setSize] = useState<readonly number[]>(SIZE);
  const [color, setColor] = useState(screenColor(COLOR));
  const field = useRef<HTMLInputElement>(null);
  useEffect(() => field.current?.select(), []);
  const add = (event: Event) => {
    event.preventDefault();
    onAdd(kind === "place" ? { kind, name } : { kind, name, size, color: linearColor(color) });
  };
  const cancel = (event: KeyboardEvent) => {
    if (event.key === "Escape") onCancel();
  };
  return (
    <form class="node-form" aria-label={kind === "object" ? t("A new part") : t("A new place")} onSubmit={add} onKeyDown={cancel}>
      <div class="node-fields">
        <div class="field">
          <label for="new-name">{kind === "object" ? t("Name of the part") : t("Name of the place")}</label>
          <input
            id="new-name"
            ref={field}
            value={name}
            required
            pattern={NAME_PATTERN}
            title={t("A letter, then letters, digits, “_” or “-”, 64 at most")}
            autoComplete="off"
            spellcheck={false}
            onInput={(event) => setName(event.currentTarget.value)}
          />
        </div>
        {kind === "object" && (
          <>
            <SizeFields id="new" size={size} onSize={setSize} />
            <div class="field">
              <label for="new-color">{t("Colour")}</label>
              <input id="new-color" type="color" value={color} onInput={(event) => setColor(event.currentTarget.value)} />
            </div>
          </>
        )}
      </div>
      <p class="small quiet">{t("It comes where there is room; drag it from there.")}</p>
      <div class="page-actions">
        <button type="button" class="button" onClick={onCancel}>
          {t("Cancel")}
        </button>
        <button type="submit" class="button primary">
          {t("Add it")}
        </button>
      </div>
    </form>
  );
}
