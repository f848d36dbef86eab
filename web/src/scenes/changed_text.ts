// A scene file's text after a part or a place was added, taken out, or made another size or colour.
import { isMap, isSeq, type YAMLMap } from "yaml";
import { itemLines, itemRemoved, linesAt } from "../yaml_text/items";
import { pairLines, pairSet, pairTakenOut } from "../yaml_text/pairs";
import { CannotEdit, commentsOf, endOf, isJson, keyEnd, lostComments, pairOf, readYaml, type YamlSource } from "../yaml_text/source";
import { spliced, type Splice } from "../yaml_text/splice";
import { inLine, sameValue } from "../yaml_text/values";
import { type Owner, readScene, SECTIONS, type Thing } from "./scene_source";
import { t } from "../words/words";

/** A part, or a place, that is to be in the file. Lengths are metres, the colour is linear red, green and blue. */
export type NewThing = { name: string; at: { x: number; y: number } } & (
  | { kind: "object"; size: readonly number[]; color: readonly number[] }
  | { kind: "place" }
);

type Owned = Pick<Thing, "name" | "owner">;

/** Have a part be as large, with all that are equal to it. Raises `CannotEdit`. */
export function resized(text: string, part: Owned, size: readonly number[]): string {
  return withField(text, part, "size", size.map(rounded));
}

/** Have a part be of a colour, with all that are equal to it. Raises `CannotEdit`. */
export function recolored(text: string, part: Owned, color: readonly number[]): string {
  return withField(text, part, "color", color.map(rounded));
}

/** To a millimetre, and a thousandth of a colour. */
function rounded(value: number): number {
  return Number(value.toFixed(3));
}

function withField(text: string, { name, owner }: Owned, key: string, value: unknown): string {
  const source = sourceOf(text);
  const map = owner === null ? null : source.doc.getIn(owner, true);
  if (!isMap(map)) throw new CannotEdit(t("{name} stands in the text as an alias of another one: change it in the text.", { name }));
  if (sameValue(map.toJS(source.doc)[key], value)) return text;
  return checked(text, spliced(text, pairSet(source, map, key, value)), owner, "");
}

/** Say one thing more, after the others of its kind. Raises `CannotEdit`. */
export function withThing(text: string, thing: NewThing): string {
  const source = sourceOf(text);
  const section = SECTIONS[thing.kind];
  const root = source.doc.contents;
  if (!isMap(root)) throw new CannotEdit(t("The text is no scene: put it right first."));
  const map = root.get(section, true);
  const some = isMap(map) && map.items.length > 0;
  if (some && pairOf(map, thing.name) !== null) throw new CannotEdit(t("'{section}' has a '{name}' already.", { name: thing.name, section }));
  const splices = some ? pairSet(source, map, thing.name, said(thing)) : firstOf(source, root, section, thing);
  const owner = [section, thing.name] as const;
  const after = checked(text, spliced(text, splices), owner, "");
  if (ownedBy(after, owner).length !== 1) throw new CannotEdit(t("'{name}' cannot be added to this text: write it there.", { name: thing.name }));
  return after;
}

function said(thing: NewThing): unknown {
  const pose = { x: rounded(thing.at.x), y: rounded(thing.at.y) };
  return thing.kind === "place" ? { pose } : { color: thing.color.map(rounded), size: thing.size.map(rounded), pose };
}

/** The first of a section: in a line of its own, where the file is written in lines. */
function firstOf(source: YamlSource, root: YAMLMap, section: string, thing: NewThing): Splice[] {
  const { text } = source;
  const json = isJson(source, root);
  if (root.flow === true) return pairSet(source, root, section, { [thing.name]: said(thing) });
  const line = `  ${inLine(thing.name, json)}: ${inLine(said(thing), json)}`;
  const pair = pairOf(root, section);
  if (pair === null) return [linesAt(text, text.length, `${section}:\n${line}\n`)];
  const colon = keyEnd(pair);
  return [{ from: colon, to: Math.max(colon, endOf(source, pair)), insert: `\n${line}` }];
}

/** Say nothing of a thing any more, nor in the comments that are its own; of a grid all go. Raises `CannotEdit`. */
export function without(text: string, thing: Thing): string {
  const { owner, where } = thing;
  if (owner === null || where === null) throw new CannotEdit(t("The file says nothing of {name}.", { name: thing.name }));
  const source = sourceOf(text);
  const several = where[2] === "poses" ? ownedBy(text, owner).length : 1;
  const { own, splices } = several > 1 ? itemGone(source, owner, Number(where[3])) : entryGone(source, owner);
  const after = checked(text, spliced(text, splices), owner, own);
  if (ownedBy(after, owner).length !== several - 1) throw new CannotEdit(t("{name} cannot be taken out of this text: take it out there.", { name: thing.name }));
  return after;
}

interface Gone {
  splices: Splice[];
  /** What went, whose comments may go with it. */
  own: string;
}

/** One of several equal things. */
function itemGone(source: YamlSource, owner: readonly string[], index: number): Gone {
  const map = source.doc.getIn(owner, true);
  const pair = isMap(map) ? pairOf(map, "poses") : null;
  if (!isMap(map) || pair === null || !isSeq(pair.value)) throw new CannotEdit(t("What is to be changed is no list."));
  const lines = pair.value.flow === true ? null : itemLines(source, pair.value, index);
  return { splices: itemRemoved(source, { map, pair }, index), own: lines === null ? "" : source.text.slice(lines.from, lines.to) };
}

/** All that the file says of a part, place or robot; of the only robot with the word for robots. */
function entryGone(source: YamlSource, [section, name]: Owner): Gone {
  const root = source.doc.contents as YAMLMap;
  const map = root.get(section, true);
  if (!isMap(map)) throw new CannotEdit(t("What is to be changed stands in the text as an alias: change it there."));
  const last = map.items.length === 1;
  const [from, key] = last ? [root, section] : [map, name];
  const { from: begin, to } = pairLines(source, from, key);
  const own = source.text.slice(begin, to);
  if (!last || section === SECTIONS.robot) return { splices: pairTakenOut(source, from, key), own };
  const pair = pairOf(root, section);
  return { splices: pair === null ? [] : [{ from: keyEnd(pair), to: endOf(source, pair), insert: " {}" }], own };
}

function sourceOf(text: string): YamlSource {
  const source = readYaml(text);
  if (source === null) throw new CannotEdit(t("The text is no scene: put it right first."));
  return source;
}

function ownedBy(text: string, owner: Owner): Thing[] {
  return (readScene(text)?.things ?? []).filter((thing) => sameValue(thing.owner, owner));
}

/** The text after a change of one entry, if all else is as it was. Raises `CannotEdit`. */
function checked(before: string, after: string, owner: Owner | null, own: string): string {
  const theirs = commentsOf(own);
  if (lostComments(before, after).some((comment) => !theirs.includes(comment))) {
    throw new CannotEdit(t("A comment stands in the way: change this in the text."));
  }
  if (!sameValue(othersThan(before, owner), othersThan(after, owner))) {
    throw new CannotEdit(t("Other things would change with it, as the text has them in one: change this in the text."));
  }
  return after;
}

function othersThan(text: string, owner: Owner | null): unknown[] | null {
  const things = readScene(text)?.things;
  if (things === undefined) return null;
  const others = things.filter((thing) => thing.owner !== null && !sameValue(thing.owner, owner));
  // A place has the size of the part that is called like it.
  return others.map(({ kind, name, pose, size, color }) => (kind === "object" ? [kind, name, pose, size, color] : [kind, name, pose]));
}
