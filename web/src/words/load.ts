// Brings the words of the reader's language, a file at a time: nobody waits for those of pages not looked at.
import { language } from "./language";
import { takeSentences } from "./said";
import { addWords, type Words } from "./words";

/** Every file of texts by where it lies. */
const files = import.meta.glob<Words>("../../texts/*/*.json", { import: "default" });

/** What there is to answer a robot, what robots say, and what notifications say. */
export async function loadAnsweringWords(): Promise<void> {
  document.documentElement.lang = language;
  const [sentences, clauses] = await Promise.all([
    wordsIn("sentences"),
    wordsIn("clauses"),
    load("answering"),
    load("notices"),
  ]);
  takeSentences(sentences, clauses);
}

/** What the other pages say. */
export function loadOtherWords(): Promise<void> {
  return load("console");
}

async function load(file: string): Promise<void> {
  addWords(await wordsIn(file));
}

/** English needs none, and what cannot be loaded stays English. */
async function wordsIn(file: string): Promise<Words> {
  const found = files[`../../texts/${language}/${file}.json`];
  return found === undefined ? {} : found().catch(() => ({}));
}
