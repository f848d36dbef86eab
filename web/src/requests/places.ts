// Places of a building, as people write and read them.
import { t } from "../words/words";

/** `F1/101` as people read it. */
export function placeInWords(place: string): string {
  return place.replace("/", " ");
}

/** What somebody means who has written a place: with its floor, or alone where no other floor has it. */
export function placeMeant(written: string, places: readonly string[]): string | { mistake: string } {
  const words = plain(written);
  const exact = places.find((place) => place === written.trim());
  if (exact !== undefined) return exact;
  const found = places.filter((place) => plain(place) === words || plain(place.slice(place.indexOf("/") + 1)) === words);
  const [only] = found;
  if (only === undefined) return { mistake: t("There is no place “{written}” here.", { written: written.trim() }) };
  if (found.length === 1) return only;
  return {
    mistake: t("“{written}” is on several floors: choose {places}.", {
      written: written.trim(),
      places: found.map(placeInWords).join(t(" or ")),
    }),
  };
}

function plain(written: string): string {
  return written
    .toLowerCase()
    .replace(/[\s/]+/g, " ")
    .replace(/\broom /, "")
    .trim();
}

/** The places by floor, both in the building's order. */
export function byFloor(places: readonly string[]): ReadonlyMap<string, readonly string[]> {
  const floors = new Map<string, string[]>();
  for (const place of places) {
    const floor = place.slice(0, place.indexOf("/"));
    const there = floors.get(floor);
    if (there === undefined) floors.set(floor, [place]);
    else there.push(place);
  }
  return floors;
}
