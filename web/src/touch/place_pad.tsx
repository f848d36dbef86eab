// A place, chosen by touch: its floor, then its number on a keypad or its name from a list.
import { useState } from "preact/hooks";
import { byFloor, placeInWords } from "../requests/places";
import { t } from "../words/words";

interface PlacePadProps {
  places: readonly string[];
  /** Where the robot is, offered first; null where that is no choice. */
  here: string | null;
  /** The floor that is shown first. */
  floor: string | null;
  choose: (place: string) => void;
}

const KEYS = ["1", "2", "3", "4", "5", "6", "7", "8", "9", "0"];
const MOST_SHOWN = 12;

export function PlacePad({ places, here, floor: first, choose }: PlacePadProps) {
  const floors = byFloor(places);
  const [floor, setFloor] = useState(first !== null && floors.has(first) ? first : [...floors.keys()][0]);
  const [digits, setDigits] = useState("");
  const there = (floors.get(floor ?? "") ?? []).filter((place) => place !== here);
  const found = there.filter((place) => fits(place, digits));
  const shown = found.slice(0, MOST_SHOWN);
  return (
    <div class="pad">
      {here !== null && (
        <button class="button touch-button" type="button" onClick={() => choose(here)}>
          {t("Here ({here})", { here: placeInWords(here) })}
        </button>
      )}
      {floors.size > 1 && (
        <div class="pad-floors" role="group" aria-label={t("Floor")}>
          {[...floors.keys()].map((each) => (
            <button
              key={each}
              class="button touch-button"
              type="button"
              aria-pressed={each === floor}
              onClick={() => setFloor(each)}
            >
              {each}
            </button>
          ))}
        </div>
      )}
      <div class="pad-room">
        <div class="pad-keys" role="group" aria-label={t("Number")}>
          <output class="pad-digits" aria-label={t("Number so far")}>
            {digits}
          </output>
          {KEYS.map((key) => (
            <button key={key} class="button touch-button" type="button" onClick={() => setDigits(digits + key)}>
              {key}
            </button>
          ))}
          <button
            class="button touch-button pad-wide"
            type="button"
            disabled={digits === ""}
            onClick={() => setDigits(digits.slice(0, -1))}
          >
            {t("Delete")}
          </button>
        </div>
        <div class="pad-places">
          {shown.map((place) => (
            <button key={place} class="button touch-button" type="button" onClick={() => choose(place)}>
              {placeInWords(place)}
            </button>
          ))}
          <p role="status" class="quiet">
            {found.length === 0 && t("No place on this floor has {digits} in its name.", { digits })}
            {found.length > shown.length &&
              t("{count} more: press the number of the room.", { count: found.length - shown.length })}
          </p>
        </div>
      </div>
    </div>
  );
}

/** Whether the digits that were pressed are in a place's name. */
function fits(place: string, digits: string): boolean {
  return place.slice(place.indexOf("/") + 1).includes(digits);
}
