// A field whose text is taken once it is entered. What is still being typed stays when the page is drawn anew meanwhile.
import { useState } from "preact/hooks";

interface EnteredInputProps {
  id: string;
  value: string;
  type?: "number" | "text";
  class?: string;
  step?: number | string;
  min?: number | undefined;
  max?: number | undefined;
  maxlength?: number;
  required?: boolean;
  placeholder?: string;
  list?: string | undefined;
  spellcheck?: boolean;
  autocomplete?: "off";
  onEnter: (input: HTMLInputElement) => void;
}

export function EnteredInput({ value, onEnter, ...rest }: EnteredInputProps) {
  const [typed, setTyped] = useState<string | null>(null);
  const enter = (input: HTMLInputElement) => {
    onEnter(input);
    if (input.validity.valid) setTyped(null);
  };
  return (
    <input
      {...rest}
      value={typed ?? value}
      onInput={(event) => setTyped(event.currentTarget.value)}
      onChange={(event) => enter(event.currentTarget)}
      onBlur={() => setTyped(null)}
    />
  );
}
