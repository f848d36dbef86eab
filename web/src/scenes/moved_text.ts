// A scene file's text after something in it was moved or turned.
import { isMap } from "yaml";
import { pairRemoved, pairSet } from "../yaml_text/pairs";
import { CannotEdit, lostComments, readYaml } from "../yaml_text/source";
import { spliced } from "../yaml_text/splice";
import type { Pose, Thing } from "./scene_source";
import { t } from "../words/words";

/** A tenth of a millimetre; angles a bit finer. */
const DIGITS = { x: 4, y: 4, z: 4, yaw: 4 } as const;

/** Say another pose, as far as `change` says one; without z it is on the table. Raises `CannotEdit`. */
export function moved(text: string, thing: Pick<Thing, "name" | "where">, change: Partial<Pose>): string {
  if (thing.where === null)
    throw new CannotEdit(t("The file says nothing of {name}: add it to 'robots' in the text first.", { name: thing.name }));
  let after = text;
  for (const key of ["x", "y", "z", "yaw"] as const) {
    const value = change[key];
    if (value !== undefined) after = said(after, thing.where, key, value);
  }
  if (lostComments(text, after).length > 0) throw new CannotEdit(t("A comment stands in the way: change this in the text."));
  return after;
}

function said(text: string, where: readonly (string | number)[], key: keyof Pose, value: number | null): string {
  const source = readYaml(text);
  const map = source?.doc.getIn(where, true);
  if (source === null || !isMap(map)) {
    throw new CannotEdit(t("The pose stands in the text as an alias of another one: change it in the text."));
  }
  if (value === null) return spliced(text, pairRemoved(source, map, key));
  const rounded = Number(value.toFixed(DIGITS[key]));
  if (map.get(key) === rounded) return text;
  return spliced(text, pairSet(source, map, key, rounded));
}

/** An angle between minus half a turn and half a turn. */
export function wrapped(yaw: number): number {
  return Math.atan2(Math.sin(yaw), Math.cos(yaw));
}
