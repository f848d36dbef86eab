// One parameter of a leaf's behavior as a field.
import { useState } from "preact/hooks";
import { EnteredInput } from "../../document/entered_input";
import { plain } from "../../tree/words";
import { enteredOf, type Parameter, valueOf } from "./parameters";
import { t } from "../../words/words";

interface ParameterFieldProps {
  parameter: Parameter;
  value: unknown;
  /** Names to choose from; others may be entered. */
  names: readonly string[];
  onValue: (value: unknown) => void;
}

export function ParameterField({ parameter, value, names, onValue }: ParameterFieldProps) {
  const [mistake, setMistake] = useState("");
  const { key, required, kind, choices, min, max } = parameter;
  const id = `parameter-${key}`;
  const enter = (entered: string) => {
    try {
      onValue(valueOf(parameter, entered));
      setMistake("");
    } catch {
      setMistake(t("What is given for '{key}' is no JSON.", { key }));
    }
  };
  const entered = enteredOf(parameter, value);
  const options = kind === "truth" ? TRUTHS : choices.map((each) => [each, each] as const);
  return (
    <div class="field">
      <label for={id}>{plain(key)}</label>
      {kind === "truth" || kind === "choice" ? (
        <select id={id} value={entered} onChange={(event) => enter(event.currentTarget.value)}>
          {!required || entered === "" ? <option value="">{t("not said")}</option> : null}
          {options.map(([each, said]) => (
            <option key={each} value={each}>
              {said}
            </option>
          ))}
        </select>
      ) : (
        <EnteredInput
          id={id}
          value={entered}
          type={kind === "number" ? "number" : "text"}
          step="any"
          min={min ?? undefined}
          max={max ?? undefined}
          required={required}
          list={names.length > 0 ? `${id}-names` : undefined}
          spellcheck={false}
          autocomplete="off"
          onEnter={(input) => enter(input.value.trim())}
        />
      )}
      {names.length > 0 && (
        <datalist id={`${id}-names`}>
          {names.map((name) => (
            <option key={name} value={name} />
          ))}
        </datalist>
      )}
      {mistake !== "" && (
        <p class="mistake small" role="alert">
          {mistake}
        </p>
      )}
    </div>
  );
}

const TRUTHS = [
  ["true", t("yes")],
  ["false", t("no")],
] as const;
