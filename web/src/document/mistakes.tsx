// What is wrong with a text, each with its line, which a click goes to.
import type { Checked } from "./checked";
import { t, tn } from "../words/words";
import { Told } from "../words/told";

interface MistakesProps {
  id: string;
  checked: Checked;
  onLine: (line: number) => void;
}

export function Mistakes({ id, checked, onLine }: MistakesProps) {
  const errors = checked.check?.errors ?? [];
  return (
    <section class="mistakes" aria-label={t("Mistakes")}>
      <p id={id} class={`verdict ${verdictKind(checked)}`} role="status">
        {verdict(checked)}
      </p>
      {errors.length > 0 && (
        <ol>
          {errors.map(({ line, message }, index) => (
            <li key={index}>
              {line === null ? (
                <p class="mistake-line"><Told text={message} /></p>
              ) : (
                <button type="button" class="mistake-line" onClick={() => onLine(line)}>
                  <strong>{t("Line {line}", { line })}</strong> <span><Told text={message} /></span>
                </button>
              )}
            </li>
          ))}
        </ol>
      )}
    </section>
  );
}

function verdictKind({ check, failure }: Checked): "unknown" | "good" | "wrong" {
  if (failure !== "" || check === null) return "unknown";
  return check.errors.length === 0 ? "good" : "wrong";
}

function verdict({ check, failure }: Checked): string {
  if (failure !== "") return t("It cannot be checked now: {failure} Your text is kept.", { failure });
  if (check === null) return t("Checking …");
  const count = check.errors.length;
  if (count === 0) return t("No mistakes");
  return tn("{count} mistake", "{count} mistakes", { count });
}
