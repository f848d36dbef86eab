// What the service and its robots say, in the reader's language. They say it in English, and of what they ask
// they also say what it is made of; what they have sensed is known by its pattern.
import type { WordedSentence, Wording } from "../wire/types";
import { decimal, filled, type Words } from "./words";

const REMEMBERED = 2_000;

const texts = new Map<string, string>();
const wordings = new Map<string, readonly WordedSentence[]>();
let patterns: readonly Pattern[] = [];
let reasons: readonly Pattern[] = [];

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

/** Take over more clauses: what was there before is looked for first. */
export function takeClauses(clauses: Words): void {
  const known = new Set(patterns.map(({ key }) => key));
  const more = Object.entries(clauses).filter(([key]) => !known.has(key));
  for (const [key, text] of more) texts.set(key, String(text));
  patterns = [...patterns, ...more.map(([key, text]) => patternOf(key, String(text)))];
}

/** Take over why a fleet does what it does, and how what fills those sentences is said: no other text is looked for among them. */
export function takeReasons(clauses: Words, fields: FieldWords): void {
  reasons = Object.entries(clauses).map(([key, text]) => patternOf(key, String(text), fields));
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

/** Why a fleet does something, as people say it; null where a part of it is only there in English. */
export function translatedReason(text: string): string | null {
  return reason(text) ?? several(text, reason);
}

/** The same, and the English one where there is no other. */
export function reasonInWords(text: string): string {
  return translatedReason(text) ?? text;
}

/** A text without known parts: itself a key, or what a pattern fits. */
function phrase(text: string): string | null {
  return texts.get(text) ?? fitting(text, patterns, (clause) => phrase(clause) ?? clause);
}

/** One clause of a reason. */
function reason(text: string): string | null {
  return fitting(text, reasons, reasonOrClauses) ?? phrase(text);
}

/** Clauses in turn: those that are only there in English stay so. */
function reasonOrClauses(text: string): string {
  return reason(text) ?? several(text, (each) => reason(each) ?? each) ?? text;
}

/** Clauses one after the other; null where there is only one, or one of them has no words. */
function several(text: string, say: (clause: string) => string | null): string | null {
  const clauses = text.split("; ");
  if (clauses.length === 1) return null;
  const found = clauses.map(say);
  return found.includes(null) ? null : found.join("; ");
}

/** What the first pattern that fits makes of a text; `say` has words for the clauses in it. */
function fitting(text: string, among: readonly Pattern[], say: (clause: string) => string): string | null {
  for (const { pattern, text: template, fields } of among) {
    const found = pattern.exec(text);
    if (found !== null) return filled(template, mapped(found.groups ?? {}, fields, say));
  }
  return null;
}

/** `rest`, `deed` and `wanted` are clauses in turn, and a part and a kind of issue may be called by words of the service's own; of what else fills a field only numbers are written otherwise. */
function mapped(groups: Readonly<Record<string, string>>, fields: FieldWords, clause: (text: string) => string): Record<string, string> {
  return Object.fromEntries(
    Object.entries(groups).map(([name, value]) => {
      const say = fields[name];
      if (say !== undefined) return [name, say(value)];
      if (name === "rest" || name === "deed" || name === "wanted") return [name, clause(value)];
      if (name === "part") return [name, texts.get(value) ?? value];
      if (name === "issue") return [name, texts.get(value.replaceAll("_", " ")) ?? value];
      const decimals = /^-?\d+\.(\d+)$/.exec(value)?.[1];
      return [name, decimals === undefined ? value : decimal(Number(value), decimals.length)];
    }),
  );
}

/** What fills a field is short, but for `rest`, `deed` and `list`; a part may have its article. */
function patternOf(key: string, text: string, fields: FieldWords = {}): Pattern {
  const escaped = key.replace(/[.*+?^$()|[\]\\]/g, "\\$&");
  const groups = escaped.replace(/\{(\w+)\}/g, (_, name: string) => {
    if (name === "rest") return "(?<rest>.+)";
    if (name === "deed") return "(?<deed>.+?)";
    if (name === "list") return "(?<list>[^;:?!]+)";
    return `${name === "part" ? "(?:the )?" : ""}(?<${name}>[^,;:?!]{1,80}?)`;
  });
  return { pattern: new RegExp(`^${groups}$`, "i"), key, text, fields };
}

function capitalized(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
