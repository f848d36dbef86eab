// What is read back to somebody, who says whether it is right.
import { useEffect, useRef, useState } from "preact/hooks";

import { SpeakButton } from "../speech/speak_button";

const YES = ["yes", "yes please", "yes that is right", "yes that's right", "that is right", "that's right", "right"];
const NO = ["no", "no thank you", "no thanks", "no that is wrong", "no that's wrong", "that is wrong", "wrong"];

interface ConfirmingProps {
  readBack: string;
  busy: boolean;
  yes: () => void;
  no: () => void;
}

export function Confirming({ readBack, busy, yes, no }: ConfirmingProps) {
  const heading = useRef<HTMLHeadingElement>(null);
  const [failure, setFailure] = useState("");
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
        <SpeakButton
          label="Say yes or no"
          heard={(words) => {
            const said = words.toLowerCase().replace(/[.,!?]/g, "").trim();
            if (YES.includes(said)) yes();
            else if (NO.includes(said)) no();
            else setFailure(`I have heard “${words}”: say yes or no, or press a button.`);
          }}
        />
      </div>
      <p class="mistake" role="alert">
        {failure}
      </p>
    </section>
  );
}
