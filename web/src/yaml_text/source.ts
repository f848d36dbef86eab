// A YAML text as it was read: its values, and where in the text each of them stands.
import {
  type Document,
  isAlias,
  isCollection,
  isMap,
  isPair,
  isScalar,
  isSeq,
  Lexer,
  type Pair,
  parseDocument,
  type ParsedNode,
  type YAMLMap,
  type YAMLSeq,
} from "yaml";
import { t } from "../words/words";

export interface YamlSource {
  text: string;
  doc: Document.Parsed;
}

/** A change that cannot be made in a text without changing more of it than was asked for. */
export class CannotEdit extends Error {}

/** Read a text; null where it is no YAML, or not one document. */
export function readYaml(text: string): YamlSource | null {
  const doc = parseDocument(text, { keepSourceTokens: true, logLevel: "silent" });
  return doc.errors.length > 0 ? null : { text, doc };
}

/** The value of a node, as JSON has it. */
export function plainOf({ doc }: YamlSource, node: unknown): unknown {
  return isCollection(node) || isScalar(node) || isAlias(node) ? node.toJS(doc) : null;
}

/** Where a node begins; what stands before it, as an anchor, is not part of it. */
export function startOf(node: unknown): number {
  const range = (node as ParsedNode | null)?.range;
  if (range === null || range === undefined) throw new CannotEdit(t("This part of the text cannot be found."));
  return range[0];
}

/** Where the content of a node or of a pair ends, without comments and space behind it. */
export function endOf(source: YamlSource, node: unknown): number {
  const { text } = source;
  let end: number;
  if (isPair(node)) {
    const key = keyEnd(node);
    end = node.value === null ? key : Math.max(key, endOf(source, node.value));
  } else if ((isMap(node) || isSeq(node)) && node.flow !== true && node.items.length > 0) {
    end = endOf(source, node.items.at(-1));
  } else {
    end = (node as ParsedNode).range?.[1] ?? startOf(node);
  }
  while (end > 0 && /\s/.test(text[end - 1] as string)) end--;
  return end;
}

/** Behind the colon of a pair, or behind its key where it has none. */
export function keyEnd(pair: Pair): number {
  const colon = pair.srcToken?.sep?.find(({ type }) => type === "map-value-ind");
  return colon === undefined ? ((pair.key as ParsedNode).range?.[1] ?? 0) : colon.offset + 1;
}

/** The pair of a mapping with this key. */
export function pairOf(map: YAMLMap, key: string): Pair | null {
  const found = map.items.find((pair) => isScalar(pair.key) && pair.key.value === key);
  return found ?? null;
}

/** Whether keys of a mapping stand in double quotes, as in JSON. */
export function isJson({ text }: YamlSource, map: YAMLMap): boolean {
  const first = map.items[0]?.key;
  return first !== undefined && text[startOf(first)] === '"';
}

/** Whether a list has no item, or is no list yet because nothing stands behind its key. */
export function isEmptyList(value: unknown): value is YAMLSeq | null {
  return value === null || (isScalar(value) && value.value === null) || (isSeq(value) && value.items.length === 0);
}

/** Every comment of a text, in order. */
export function commentsOf(text: string): string[] {
  const comments: string[] = [];
  let scalar = false;
  for (const lexeme of new Lexer().lex(text)) {
    if (!scalar && lexeme.startsWith("#")) comments.push(lexeme.trimEnd());
    scalar = lexeme === "\u001F";
  }
  return comments;
}

/** Comments of a text that are missing in another one. */
export function lostComments(before: string, after: string): string[] {
  const left = new Map<string, number>();
  for (const comment of commentsOf(after)) left.set(comment, (left.get(comment) ?? 0) + 1);
  return commentsOf(before).filter((comment) => {
    const count = left.get(comment) ?? 0;
    left.set(comment, count - 1);
    return count <= 0;
  });
}
