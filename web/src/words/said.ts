// What the service and its robots say, in the reader's language. They say it in English, and of what they ask
// they also say what it is made of; what they have sensed is known by its pattern.
import type { WordedSentence, Wording } from "../wire/types";
import { decimal, filled, type Words } from "./words";

const REMEMBERED = 2_000;

const texts = new Map<string, string>();
const wordings = new Map<string, readonly WordedSentence[]>();
let patterns: readonly Pattern[] = [];

interface Pattern {
  key: string;
  pattern: RegExp;
  text: string;
  fields: FieldWords;
}

/** By what a field is called, how what fills it is said. */
export type FieldWords = Readonly<Record<string, (value: string) => string>>;

/** Take over `sentences` by their English text with fields, and `clauses`, which are also known filled in. */
export function takeSentences(sentences: Words, clauses: Words): void {
  texts.clear();
  for (const [key, text] of Object.entries(sentences)) texts.set(key, String(text));
  patterns = [];
  takeClauses(clauses);
}

/** Take over more clauses, some of whose fields have words of their own: what was there before is looked for first. */
export function takeClauses(clauses: Words, fields: FieldWords = {}): void {
  const known = new Set(patterns.map(({ key }) => key));
  const more = Object.entries(clauses).filter(([key]) => !known.has(key));
  for (const [key, text] of more) texts.set(key, String(text));
  patterns = [...patterns, ...more.map(([key, text]) => ({ key, pattern: patternOf(key), text: String(text), fields }))];
}

/** Remember what texts are made of; what was not heard of for long is forgotten. */
export function learn(more: readonly Wording[]): void {
  if (texts.size === 0) return;
  for (const { text, sentences } of more) {
    if (sentences.length === 0) continue;
    wordings.delete(text);
    wordings.set(text, sentences);
  }
  for (const [oldest] of wordings) {
    if (wordings.size <= REMEMBERED) break;
    wordings.delete(oldest);
  }
}

/** An English text in the reader's language; null where nobody has put it into that. */
export function translated(text: string): string | null {
  if (texts.size === 0) return null;
  const sentences = wordings.get(text);
  return sentences === undefined ? phrase(text) : all(sentences);
}

/** The same, and the English one where there is no other. */
export function said(text: string): string {
  return translated(text) ?? text;
}

/** Why something could not be done, in the reader's language where it is in that. */
export function whyNotDone(error: unknown): string {
  return (error as Error).message.split("\n").map(said).join("\n");
}

/** A text put together of sentences; null where one of them is only there in English. */
function all(sentences: readonly WordedSentence[]): string | null {
  const found: string[] = [];
  for (const each of sentences) {
    const text = sentence(each);
    if (text === null) return null;
    found.push(capitalized(text));
  }
  return found.join(" ");
}

function sentence({ key, args }: WordedSentence): string | null {
  const template = texts.get(key);
  if (template === undefined) return Object.keys(args).length === 0 ? phrase(key) : null;
  const values: Record<string, string> = {};
  for (const [name, value] of Object.entries(args)) {
    values[name] = typeof value === "string" ? value : (value ?? []).map((each) => sentence(each) ?? filled(each.key)).join(" ");
  }
  return filled(template, values);
}

/** A text without known parts: itself a key, or what a pattern fits. */
function phrase(text: string): string | null {
  const whole = texts.get(text);
  if (whole !== undefined) return whole;
  for (const { pattern, text: template, fields } of patterns) {
    const groups = pattern.exec(text)?.groups;
    if (groups !== undefined) return filled(template, mapped(groups, fields));
  }
  return several(text);
}

/** Clauses one after the other; null where one of them is only there in English. */
function several(text: string): string | null {
  const clauses = text.split("; ");
  if (clauses.length === 1) return null;
  const found = clauses.map(phrase);
  return found.includes(null) ? null : found.join("; ");
}

/** A clause in turn, or several: those that are only there in English stay so. */
function clausesIn(text: string): string {
  return phrase(text) ?? text.split("; ").map((each) => phrase(each) ?? each).join("; ");
}

/** `rest`, `deed` and `wanted` are clauses in turn, and a part and a kind of issue may be called by words of the service's own; of what else fills a field only numbers are written otherwise. */
function mapped(groups: Readonly<Record<string, string>>, fields: FieldWords): Record<string, string> {
  return Object.fromEntries(
    Object.entries(groups).map(([name, value]) => {
      const say = fields[name];
      if (say !== undefined) return [name, say(value)];
      if (name === "rest" || name === "deed" || name === "wanted") return [name, clausesIn(value)];
      if (name === "part") return [name, texts.get(value) ?? value];
      if (name === "issue") return [name, texts.get(value.replaceAll("_", " ")) ?? value];
      const decimals = /^-?\d+\.(\d+)$/.exec(value)?.[1];
      return [name, decimals === undefined ? value : decimal(Number(value), decimals.length)];
    }),
  );
}

/** What fills a field is short, but for `rest`, `deed` and `list`; a part may have its article. */
function patternOf(key: string): RegExp {
  const escaped = key.replace(/[.*+?^$()|[\]\\]/g, "\\$&");
  const fields = escaped.replace(/\{(\w+)\}/g, (_, name: string) => {
    if (name === "rest") return "(?<rest>.+)";
    if (name === "deed") return "(?<deed>.+?)";
    if (name === "list") return "(?<list>[^;:?!]+)";
    return `${name === "part" ? "(?:the )?" : ""}(?<${name}>[^,;:?!]{1,80}?)`;
  });
  return new RegExp(`^${fields}$`, "i");
}

function capitalized(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
