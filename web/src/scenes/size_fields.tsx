// How large a part is, in numbers.
import { EnteredInput } from "../document/entered_input";
import { SMALLEST_M } from "./thing_change";
import { t } from "../words/words";

interface SizeFieldsProps {
  /** What the ids of the fields begin with. */
  id: string;
  size: readonly number[];
  onSize: (size: readonly number[]) => void;
}

const EXTENTS = [t("Deep x (m)"), t("Wide y (m)"), t("High z (m)")];

export function SizeFields({ id, size, onSize }: SizeFieldsProps) {
  const enter = (index: number, input: HTMLInputElement) => {
    if (input.reportValidity()) onSize(size.map((each, at) => (at === index ? input.valueAsNumber : each)));
  };
  return (
    <>
      {EXTENTS.map((said, index) => (
        <div key={said} class="field">
          <label for={`${id}-size-${index}`}>{said}</label>
          <EnteredInput
            id={`${id}-size-${index}`}
            type="number"
            required
            min={SMALLEST_M}
            step="any"
            value={String(Number((size[index] ?? 0).toFixed(3)))}
            onEnter={(input) => enter(index, input)}
          />
        </div>
      ))}
    </>
  );
}
