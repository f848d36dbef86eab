// One thing that is asked at a robot's touch screen: a text, or a place.
import { useEffect, useId, useRef, useState } from "preact/hooks";
import { type Kind, THIS } from "../requests/wish";
import { PlacePad } from "./place_pad";
import { type Asked, isText, nextStep, type Step } from "./steps";
import { t } from "../words/words";

interface StepFormProps {
  asked: Asked;
  places: readonly string[];
  here: string | null;
  /** What was typed for it before, and is not to be lost. */
  typed: string;
  answered: (asked: Asked) => void;
}

export function StepForm({ asked, places, here, typed, answered }: StepFormProps) {
  const step = nextStep(asked);
  const heading = useRef<HTMLHeadingElement>(null);
  useEffect(() => heading.current?.focus(), [step]);
  if (step === null) return null;
  const answer = (value: string) => answered({ ...asked, answers: [...asked.answers, value] });
  const origin = asked.kind === "transport" ? asked.answers[1] : here;
  return (
    <>
      <h2 ref={heading} tabIndex={-1}>
        {questionOf(step, asked.kind)}
      </h2>
      {isText(step) ? (
        <TextAnswer key={step} step={step} typed={typed} answer={answer} />
      ) : (
        <PlacePad
          key={step}
          places={step === "destination" ? places.filter((each) => each !== origin) : places}
          here={step === "origin" || step === "place" ? here : null}
          floor={here === null ? null : here.slice(0, here.indexOf("/"))}
          choose={answer}
        />
      )}
    </>
  );
}

function questionOf(step: Step, kind: Kind): string {
  switch (step) {
    case "what":
      return t("What am I to bring?");
    case "message":
      return t("What am I to tell?");
    case "origin":
      return t("From where?");
    case "destination":
      return t("To where?");
    case "place":
      return kind === "deliver_message" ? t("Where am I to tell it?") : t("Where am I to come?");
  }
}

const LONGEST = 300;

interface TextAnswerProps {
  step: "what" | "message";
  typed: string;
  answer: (text: string) => void;
}

function TextAnswer({ step, typed, answer }: TextAnswerProps) {
  const id = useId();
  const [text, setText] = useState(typed);
  return (
    <form
      class="touch-text"
      onSubmit={(event) => {
        event.preventDefault();
        if (text.trim() !== "") answer(text.trim());
      }}
    >
      {step === "what" && (
        <button class="button touch-button" type="button" onClick={() => answer(THIS)}>
          {t("This, which I have here")}
        </button>
      )}
      <label for={id}>{step === "what" ? t("Or something else, such as “the mail”") : t("The message, as it is to be told")}</label>
      <input
        id={id}
        class="input"
        autocomplete="off"
        maxLength={LONGEST}
        value={text}
        onInput={(event) => setText(event.currentTarget.value)}
      />
      <button class="button touch-button primary" disabled={text.trim() === ""}>
        {t("Go on")}
      </button>
    </form>
  );
}
