// The words of the console. They stand in the code in English; other languages have them by that text.
import type { ComponentChildren } from "preact";
import type answering from "../../texts/de/answering.json";
import type others from "../../texts/de/console.json";
import type notices from "../../texts/de/notices.json";
import { locale } from "./language";

type Catalogue = typeof answering & typeof others & typeof notices;

/** A text that every language has; with `Plural` one that depends on a number, by its form for many. */
export type Key = { [K in keyof Catalogue]: Catalogue[K] extends string ? K : never }[keyof Catalogue];
export type PluralKey = Exclude<keyof Catalogue, Key>;

/** The forms of a text by `Intl.PluralRules`: `one`, `other`, and whichever a language has besides. */
export type Plural = Readonly<Partial<Record<Intl.LDMLPluralRule, string>>> & { readonly other: string };

export type Words = Readonly<Record<string, string | Plural>>;

type FieldsOf<K extends string> = K extends `${string}{${infer Field}}${infer Rest}` ? Field | FieldsOf<Rest> : never;
type Values<Field extends string, Value> = Readonly<Record<Field, Value>>;
type Filling<K extends string, Value> = [FieldsOf<K>] extends [never] ? [] : [values: Values<FieldsOf<K>, Value>];

const words = new Map<string, string | Plural>();
const rules = new Intl.PluralRules(locale);

export function addWords(more: Words): void {
  for (const [key, text] of Object.entries(more)) words.set(key, text);
}

/** A text in the reader's language, its fields filled in. */
export function t<const K extends Key>(key: K, ...[values]: Filling<K, string | number>): string {
  return filled(textOf(key), values);
}

/** A text that depends on how many; `one` is English, and `many` the key. */
export function tn(
  one: string,
  many: PluralKey,
  { count }: { readonly count: number },
): string {
  const forms = words.get(many) ?? { one, other: many };
  const form = typeof forms === "string" ? forms : (forms[rules.select(count)] ?? forms.other);
  return filled(form, { count: count.toLocaleString(locale) });
}

/** A text some of whose fields are links, times or the like. */
export function parts<const K extends Key>(key: K, values: Values<FieldsOf<K>, ComponentChildren>): ComponentChildren[] {
  const given: Readonly<Record<string, ComponentChildren>> = values;
  return textOf(key)
    .split(/\{(\w+)\}/)
    .map((part, index) => (index % 2 === 0 ? part : given[part]));
}

/** A number with so many decimals, as the reader writes it. */
export function decimal(value: number, decimals: number): string {
  const digits = { minimumFractionDigits: decimals, maximumFractionDigits: decimals };
  return new Intl.NumberFormat(locale, { ...digits, useGrouping: false }).format(value);
}

/** One after the other, the last after an "or". */
export function anyOf(texts: Iterable<string>): string {
  return new Intl.ListFormat(locale, { type: "disjunction" }).format(texts);
}

/** One after the other, the last after an "and". */
export function allOf(texts: Iterable<string>): string {
  return new Intl.ListFormat(locale, { type: "conjunction" }).format(texts);
}

function textOf(key: string): string {
  const text = words.get(key);
  return text === undefined ? english(key) : typeof text === "string" ? text : text.other;
}

/** Where one English text stands for two, its key says after a bar which it is. */
function english(key: string): string {
  return key.split("|", 1)[0] ?? key;
}

export function filled(text: string, values: Readonly<Record<string, string | number>> = {}): string {
  return text.replace(/\{(\w+)\}/g, (field, name: string) => String(values[name] ?? field));
}
