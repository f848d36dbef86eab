// An example of what to ask for in words.
import { byFloor, placeInWords } from "./places";

/**
 * A sentence in English, as it is understood, about places that are there, on different floors where there are several.
 * Only where it is known where they stand (`here`) can anybody say "this".
 */
export function exampleFor(places: readonly string[], here: string | null = null): string {
  if (here !== null) {
    const other = places.find((place) => place !== here);
    return other === undefined ? "come here" : `bring this to ${placeInWords(other)}`;
  }
  const floors = [...byFloor(places).values()];
  const [origin] = floors[0] ?? [];
  const destination = floors.length > 1 ? floors.at(-1)?.[0] : floors[0]?.[1];
  if (origin === undefined || destination === undefined) return "come to room 203";
  return `bring the mail from ${placeInWords(origin)} to ${placeInWords(destination)}`;
}
