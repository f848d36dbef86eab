// What is read back to somebody, who says whether it is right.
import { useEffect, useRef } from "preact/hooks";

interface ConfirmingProps {
  readBack: string;
  busy: boolean;
  yes: () => void;
  no: () => void;
}

export function Confirming({ readBack, busy, yes, no }: ConfirmingProps) {
  const heading = useRef<HTMLHeadingElement>(null);
  useEffect(() => heading.current?.focus(), [readBack]);
  return (
    <section class="confirming" aria-label="Is that right?">
      <h2 ref={heading} tabIndex={-1}>
        {readBack}
      </h2>
      <div class="confirming-buttons">
        <button class="button primary" type="button" disabled={busy} onClick={yes}>
          Yes, that is right
        </button>
        <button class="button" type="button" disabled={busy} onClick={no}>
          No
        </button>
      </div>
    </section>
  );
}
