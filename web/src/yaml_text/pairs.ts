// Setting, adding and removing keys of mappings in a YAML text.
import { isCollection, isScalar, type Pair, type YAMLMap } from "yaml";
import { commentsBelow, linesAt, withCommentsAbove } from "./items";
import { CannotEdit, endOf, isJson, keyEnd, pairOf, startOf, type YamlSource } from "./source";
import { beginsLine, columnOf, lineEnd, lineStart, type Splice } from "./splice";
import { inLine } from "./values";
import { t } from "../words/words";

/** Have a key say something else, or say something at all; a new one stands last, or `first`. */
export function pairSet(source: YamlSource, map: YAMLMap, key: string, value: unknown, first = false): Splice[] {
  const pair = pairOf(map, key);
  const written = inLine(value, isJson(source, map));
  return [pair === null ? added(source, map, key, written, first) : changed(source, pair, written)];
}

function changed(source: YamlSource, pair: Pair, written: string): Splice {
  const colon = keyEnd(pair);
  const { value } = pair;
  const lines = (isCollection(value) && value.flow !== true) || (isScalar(value) && /^[|>]/.test(source.text.slice(startOf(value))));
  if (value === null || lines || startOf(value) === endOf(source, value) || endOf(source, value) <= colon) {
    return { from: colon, to: endOf(source, pair), insert: ` ${written}` };
  }
  return { from: startOf(value), to: endOf(source, value), insert: written };
}

function added(source: YamlSource, map: YAMLMap, key: string, written: string, first: boolean): Splice {
  const { text } = source;
  const said = `${inLine(key, isJson(source, map))}: ${written}`;
  const [begin, last] = [map.items[0], map.items.at(-1)];
  if (begin === undefined || last === undefined) {
    const at = endOf(source, map) - 1;
    return { from: at, to: at, insert: said };
  }
  const start = startOf(begin.key);
  const pad = " ".repeat(columnOf(text, start));
  if (first) return { from: start, to: start, insert: map.flow === true ? `${said}, ` : `${said}\n${pad}` };
  const end = endOf(source, last);
  if (map.flow === true) return { from: end, to: end, insert: `, ${said}` };
  return linesAt(text, lineEnd(text, end), `${pad}${said}\n`);
}

/** Say nothing of a key any more; the comment behind it stays. */
export function pairRemoved(source: YamlSource, map: YAMLMap, key: string): Splice[] {
  const index = map.items.findIndex((pair) => isScalar(pair.key) && pair.key.value === key);
  const pair = map.items[index];
  if (pair === undefined) return [];
  const [from, to] = [startOf(pair.key), endOf(source, pair)];
  if (map.items.length === 1) throw new CannotEdit(t("Nothing would be left without '{key}'.", { key }));
  return map.flow === true ? removedInBraces(source, map, index, from, to) : removedLines(source, map, index, from, to);
}

/** Where a key of a mapping in lines stands, with the comments above it in its column, and those under it. */
export function pairLines(source: YamlSource, map: YAMLMap, key: string): { from: number; to: number } {
  const { text } = source;
  const pair = pairOf(map, key);
  if (pair === null) throw new CannotEdit(t("This part of the text cannot be found."));
  const [start, end] = [startOf(pair.key), endOf(source, pair)];
  if (map.flow === true || !beginsLine(text, start)) return { from: start, to: end };
  return { from: withCommentsAbove(text, start), to: commentsBelow(text, lineEnd(text, end), columnOf(text, start)) };
}

/** Say nothing of a key any more, nor in the comments that are its own. */
export function pairTakenOut(source: YamlSource, map: YAMLMap, key: string): Splice[] {
  const pair = pairOf(map, key);
  if (map.flow === true || pair === null || !beginsLine(source.text, startOf(pair.key))) return pairRemoved(source, map, key);
  return [{ ...pairLines(source, map, key), insert: "" }];
}

function removedInBraces(source: YamlSource, map: YAMLMap, index: number, from: number, to: number): Splice[] {
  const behind = map.items[index + 1];
  const before = map.items[index - 1];
  const splice =
    behind === undefined
      ? { from: endOf(source, before), to, insert: "" }
      : { from, to: startOf(behind.key), insert: "" };
  if (source.text.slice(splice.from, from).includes("#") || source.text.slice(to, splice.to).includes("#")) {
    throw new CannotEdit(t("A comment stands beside the comma here: change this in the text."));
  }
  return [splice];
}

function removedLines({ text }: YamlSource, map: YAMLMap, index: number, from: number, to: number): Splice[] {
  const end = lineEnd(text, to);
  if (text.slice(to, end).trim() !== "") return [{ from, to, insert: "" }];
  const begin = lineStart(text, from);
  if (text.slice(begin, from).trim() === "") return [{ from: begin, to: end, insert: "" }];
  const next = map.items[index + 1];
  const between = next === undefined ? "" : text.slice(end, startOf(next.key));
  // Behind the dash of a list's item: the next key comes there.
  return [{ from, to: next === undefined || between.includes("#") ? to : startOf(next.key), insert: "" }];
}
