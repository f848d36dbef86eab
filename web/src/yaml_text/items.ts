// Taking items out of lists of a YAML text, and putting them in, with the comments that are theirs.
import { isMap, isSeq, type Pair, type YAMLMap, type YAMLSeq } from "yaml";
import { CannotEdit, commentsOf, endOf, isEmptyList, isJson, keyEnd, readYaml, startOf, type YamlSource } from "./source";
import { beginsLine, columnOf, lineEnd, lineStart, shifted, type Splice } from "./splice";
import { inLine, itemInLines } from "./values";
import { t } from "../words/words";

/** The list behind a key of a mapping. */
export interface Owner {
  map: YAMLMap;
  pair: Pair;
}

/** An item on its way: as it stands in lines, from its comments on, or in brackets, or a new value. */
export type Item = { lines: string } | { flow: string } | { value: unknown };

/** The lines of one item of a list that is written in lines. */
interface ItemLines {
  from: number;
  to: number;
  column: number;
}

const COMMENT = /^ *#/;

/** Raises `CannotEdit` where it is none. */
export function listOf({ pair }: Owner): YAMLSeq {
  if (!isSeq(pair.value)) throw new CannotEdit(t("What is to be changed is no list."));
  return pair.value;
}

/** Where an item stands, with the comments above it in the same column, and those under it. */
export function itemLines({ text, ...source }: YamlSource, list: YAMLSeq, index: number): ItemLines {
  const token = list.srcToken;
  const starts = token?.type === "block-seq" ? token.items[index]?.start : undefined;
  const dash = starts?.find(({ type }) => type === "seq-item-ind");
  if (dash === undefined) throw new CannotEdit(t("This item of a list cannot be found in the text."));
  const column = columnOf(text, dash.offset);
  const from = withCommentsAbove(text, dash.offset);
  const item = list.items[index];
  const content = item === null ? dash.offset + 1 : Math.max(dash.offset + 1, endOf({ text, ...source }, item));
  return { from, to: commentsBelow(text, lineEnd(text, content), column), column };
}

/** Where the line of an offset begins, or the comments right above it in the same column. */
export function withCommentsAbove(text: string, offset: number): number {
  const column = columnOf(text, offset);
  let from = lineStart(text, offset);
  while (from > 0) {
    const above = lineStart(text, from - 1);
    const line = text.slice(above, from);
    if (!COMMENT.test(line) || line.indexOf("#") !== column) break;
    from = above;
  }
  return from;
}

/** The end of the comments from an offset on that stand farther right than a column. */
export function commentsBelow(text: string, offset: number, column: number): number {
  let end = offset;
  for (let at = offset; at < text.length; at = lineEnd(text, at)) {
    const line = text.slice(at, lineEnd(text, at));
    if (line.trim() === "") continue;
    if (!COMMENT.test(line) || line.indexOf("#") <= column) break;
    end = lineEnd(text, at);
  }
  return end;
}

/** An item as it stands, to be put elsewhere. */
export function itemOf(source: YamlSource, owner: Owner, index: number): Item {
  const list = listOf(owner);
  if (list.flow === true) {
    const item = list.items[index];
    return { flow: source.text.slice(startOf(item), endOf(source, item)) };
  }
  const { from, to, column } = itemLines(source, list, index);
  const lines = shifted(source.text.slice(from, to), -column);
  return { lines: lines.endsWith("\n") ? lines : `${lines}\n` };
}

/** Take an item out of its list. */
export function itemRemoved(source: YamlSource, owner: Owner, index: number): Splice[] {
  const list = listOf(owner);
  if (list.flow === true) return removedInBrackets(source, list, index);
  const { from, to } = itemLines(source, list, index);
  const gone: Splice = { from, to, insert: "" };
  if (list.items.length > 1) return [gone];
  const colon = keyEnd(owner.pair);
  return [gone, { from: colon, to: colon, insert: " []" }];
}

function removedInBrackets(source: YamlSource, list: YAMLSeq, index: number): Splice[] {
  const { text } = source;
  const own: Splice = { from: startOf(list.items[index]), to: endOf(source, list.items[index]), insert: "" };
  const count = list.items.length;
  if (count === 1) return [own];
  const behind = index < count - 1;
  const [first, second] = behind ? [index, index + 1] : [index - 1, index];
  const gap = [endOf(source, list.items[first]), startOf(list.items[second])] as const;
  if (!text.slice(...gap).includes("#")) return [behind ? { ...own, to: gap[1] } : { ...own, from: gap[0] }];
  const token = list.srcToken?.type === "flow-collection" ? list.srcToken.items[second] : undefined;
  const comma = token?.start.find(({ type }) => type === "comma");
  if (comma === undefined) throw new CannotEdit(t("The comma between two items of a list cannot be found."));
  return [own, { from: comma.offset, to: comma.offset + 1, insert: "" }];
}

/** Put an item into a list, so that it has this index. */
export function itemInserted(source: YamlSource, owner: Owner, index: number, item: Item): Splice {
  const { map, pair } = owner;
  if (isEmptyList(pair.value)) return firstItem(source, owner, item);
  const list = listOf(owner);
  if (list.flow === true) return insertedInBrackets(source, list, index, flowOf(item, isJson(source, map)));
  const last = list.items.length - 1;
  const beside = itemLines(source, list, Math.min(index, last));
  return linesAt(source.text, index > last ? beside.to : beside.from, shifted(linesOf(item, beside.column), beside.column));
}

/** Whole lines at the beginning of a line, or at the end of a text whose last line has no break. */
export function linesAt(text: string, at: number, lines: string): Splice {
  const unfinished = at > 0 && text[at - 1] !== "\n";
  return { from: at, to: at, insert: unfinished ? `\n${lines.replace(/\n$/, "")}` : lines };
}

function firstItem(source: YamlSource, { map, pair }: Owner, item: Item): Splice {
  const { text } = source;
  const list = isSeq(pair.value) ? pair.value : null;
  const colon = keyEnd(pair);
  const inside = list === null ? "" : text.slice(startOf(list), endOf(source, list));
  if (map.flow === true || inside.includes("#")) {
    const flow = flowOf(item, isJson(source, map));
    if (list === null) return { from: colon, to: colon, insert: ` [${flow}]` };
    const end = endOf(source, list) - 1;
    return { from: end, to: end, insert: flow };
  }
  // The comment behind the key stays there, and the lines come under it.
  const end = list === null ? colon : endOf(source, list);
  const rest = text.slice(end, lineEnd(text, end));
  const column = columnOf(text, startOf(pair.key)) + 2;
  const lines = shifted(linesOf(item, column), column);
  const before = rest.endsWith("\n") ? rest : `${rest}\n`;
  return { from: colon, to: end + rest.length, insert: before + (text.endsWith("\n") ? lines : lines.replace(/\n$/, "")) };
}

function insertedInBrackets({ text, ...source }: YamlSource, list: YAMLSeq, index: number, flow: string): Splice {
  const last = list.items.length - 1;
  const beside = startOf(list.items[Math.min(index, last)]);
  const own = beginsLine(text, beside) ? `\n${" ".repeat(columnOf(text, beside))}` : " ";
  if (index <= last) return { from: beside, to: beside, insert: `${flow},${own}` };
  const end = endOf({ text, ...source }, list.items[last]);
  return { from: end, to: end, insert: `,${own}${flow}` };
}

/** An item in lines from the left edge on; those of one in brackets keep clear of `column`. */
export function linesOf(item: Item, column: number): string {
  if ("lines" in item) return item.lines;
  if ("value" in item) return itemInLines(item.value);
  const [first, ...rest] = item.flow.split("\n");
  const indented = rest.map((line) => {
    const room = /^ */.exec(line)?.[0].length ?? 0;
    return line.trim() === "" ? "" : " ".repeat(Math.max(2, room - column)) + line.trimStart();
  });
  return `- ${[first, ...indented].join("\n")}\n`;
}

/** An item as it can stand in brackets. */
export function flowOf(item: Item, json: boolean): string {
  if ("flow" in item) return item.flow;
  if ("value" in item) return inLine(item.value, json);
  if (commentsOf(item.lines).length > 0) {
    throw new CannotEdit(t("What has comments cannot go into a list in brackets: write that list in lines first."));
  }
  const read = readYaml(item.lines)?.doc.contents;
  const only = isSeq(read) ? read.items[0] : null;
  if (!isMap(only)) throw new CannotEdit(t("This item of a list cannot be written in brackets."));
  return inLine(only.toJSON(), json);
}
