// A field of the form with its name, its hint and its mistake.
import type { ComponentChildren } from "preact";
import type { StartField, StartMistakes } from "./start_mistakes";

interface FieldProps {
  field: StartField;
  label: string;
  mistakes: StartMistakes;
  hint?: string;
  children: ComponentChildren;
}

export function Field({ field, label, mistakes, hint, children }: FieldProps) {
  return (
    <div class="field">
      <label for={`start-${field}`}>{label}</label>
      {children}
      {hint !== undefined && (
        <p id={`start-${field}-hint`} class="small quiet">
          {hint}
        </p>
      )}
      <Mistake field={field} mistakes={mistakes} />
    </div>
  );
}

export function Mistake({ field, mistakes }: { field: StartField | "form"; mistakes: StartMistakes }) {
  return (
    <p id={`start-${field}-mistake`} class="mistake small" role="alert">
      {mistakes[field]}
    </p>
  );
}

/** What ties a control to its hint and its mistake. */
export function told(field: StartField, mistakes: StartMistakes) {
  return {
    "aria-invalid": mistakes[field] !== undefined,
    "aria-describedby": `start-${field}-hint start-${field}-mistake`,
  };
}
