// Brings the words of the reader's language, a file at a time: nobody waits for those of pages not looked at.
import { language } from "./language";
import { takeClauses, takeReasons, takeSentences } from "./said";
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

/** What the other pages say, why the service refuses what is done there, and why a fleet does what it does. */
export async function loadOtherWords(): Promise<void> {
  const [refusals] = await Promise.all([wordsIn("refusals"), load("console"), loadReasons()]);
  takeClauses(refusals);
}

/** In English too: names and times are not as the service writes them. */
async function loadReasons(): Promise<void> {
  const [{ REASON_FIELDS, IN_ENGLISH }, reasons] = await Promise.all([import("../fleet/reason_words"), wordsIn("reasons")]);
  takeReasons(language === "en" ? IN_ENGLISH : reasons, REASON_FIELDS);
}

async function load(file: string): Promise<void> {
  addWords(await wordsIn(file));
}

/** English needs none, and what cannot be loaded stays English. */
async function wordsIn(file: string): Promise<Words> {
  const found = files[`../../texts/${language}/${file}.json`];
  return found === undefined ? {} : found().catch(() => ({}));
}
