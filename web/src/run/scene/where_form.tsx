// Where to put an object: a place of the scene by name; the table itself is clicked in the picture.
import { useEffect, useRef, useState } from "preact/hooks";
import { plain } from "./interventions";
import { parts, t } from "../../words/words";

interface Props {
  object: string;
  places: readonly string[];
  /** Whether there is a picture in which to click on the table. */
  drawn: boolean;
  onPlace(place: string): void;
  onCancel(): void;
}

export function WhereForm({ object, places, drawn, onPlace, onCancel }: Props) {
  const [place, setPlace] = useState(places[0] ?? "");
  const form = useRef<HTMLFormElement>(null);
  // Chosen from a menu that is gone by now: whoever uses keys goes on here.
  useEffect(() => {
    form.current?.scrollIntoView({ block: "nearest" });
    form.current?.querySelector<HTMLElement>("select, button")?.focus({ preventScroll: true });
  }, []);
  const named = { object: <strong>{plain(object)}</strong> };
  const submit = (event: SubmitEvent) => {
    event.preventDefault();
    onPlace(place);
  };
  const leave = (event: KeyboardEvent) => {
    if (event.key === "Escape") onCancel();
  };
  return (
    <form ref={form} class="scene-where" onSubmit={submit} onKeyDown={leave}>
      <p>
        {drawn
          ? places.length > 0
            ? parts("Click on the table where to put the {object}, or choose a place.", named)
            : parts("Click on the table where to put the {object}.", named)
          : parts("Choose where to put the {object}.", named)}
      </p>
      {places.length > 0 && (
        <>
          <label class="unseen" for="scene-place">
            {t("Place")}
          </label>
          <select id="scene-place" class="input" value={place} onChange={(event) => setPlace(event.currentTarget.value)}>
            {places.map((each) => (
              <option key={each} value={each}>
                {plain(each)}
              </option>
            ))}
          </select>
          <button class="button primary" type="submit">
            {t("Put there")}
          </button>
        </>
      )}
      <button class="button" type="button" onClick={onCancel}>
        {t("Cancel")}
      </button>
    </form>
  );
}
