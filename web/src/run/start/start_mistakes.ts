// Which field of a run's start a refusal of the service is about, in the reader's language.
import { said } from "../../words/said";

export type StartField =
  | "tree"
  | "world"
  | "robots"
  | "scenario"
  | "speed"
  | "seed"
  | "answers"
  | "interventions"
  | "max_attempts"
  | "autonomy";

/** What is said at each field; `form` has what is about none of them. */
export type StartMistakes = Partial<Record<StartField | "form", string>>;

const FIELDS: ReadonlySet<string> = new Set<StartField>([
  "tree",
  "world",
  "robots",
  "scenario",
  "speed",
  "seed",
  "answers",
  "interventions",
  "max_attempts",
  "autonomy",
]);

/** The first of these that a sentence fits says which field it is about. */
const ABOUT: readonly (readonly [RegExp, StartField])[] = [
  [/'robots'|\brobot '/, "robots"],
  [/\bscenario '/, "scenario"],
  [/\bsite\b/, "world"],
  [/\btree '/, "tree"],
  [/\bworld\b/, "world"],
];

/** Sort sentences, as of a problem document's `errors`, to the fields that they are about. */
export function atTheirFields(sentences: readonly string[]): StartMistakes {
  const found: StartMistakes = {};
  for (const sentence of sentences) {
    const [field, text] = placed(sentence);
    found[field] = found[field] === undefined ? text : `${found[field]} ${text}`;
  }
  return found;
}

function placed(sentence: string): [StartField | "form", string] {
  const named = /^body\.(\w+)[^:]*: (.*)$/.exec(sentence);
  if (named?.[1] !== undefined && FIELDS.has(named[1])) {
    return [named[1] as StartField, finished(said(named[2] ?? ""))];
  }
  const field = ABOUT.find(([pattern]) => pattern.test(sentence))?.[1];
  return [field ?? "form", finished(said(sentence))];
}

function finished(text: string): string {
  const sentence = text.charAt(0).toUpperCase() + text.slice(1);
  return /[.!?]$/.test(sentence) ? sentence : `${sentence}.`;
}
