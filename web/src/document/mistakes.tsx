// What is wrong with a text, each with its line, which a click goes to.
import type { Checked } from "./checked";

interface MistakesProps {
  id: string;
  checked: Checked;
  onLine: (line: number) => void;
}

export function Mistakes({ id, checked, onLine }: MistakesProps) {
  const errors = checked.check?.errors ?? [];
  return (
    <section class="mistakes" aria-label="Mistakes">
      <p id={id} class={`verdict ${verdictKind(checked)}`} role="status">
        {verdict(checked)}
      </p>
      {errors.length > 0 && (
        <ol>
          {errors.map(({ line, message }, index) => (
            <li key={index}>
              {line === null ? (
                <p class="mistake-line">{message}</p>
              ) : (
                <button type="button" class="mistake-line" onClick={() => onLine(line)}>
                  <strong>Line {line}</strong> <span>{message}</span>
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
  if (failure !== "") return `It cannot be checked now: ${failure} Your text is kept.`;
  if (check === null) return "Checking …";
  const count = check.errors.length;
  if (count === 0) return "No mistakes";
  return count === 1 ? "1 mistake" : `${count} mistakes`;
}
