// What is wrong with the words of the console: `node scripts/check_words.mjs` says so, a line each.
//
// Every text that the code says has to be in every language, with the same fields and all plural forms, and no
// other; in the file that is there when it is said; and nothing may be said that is not such a text.
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { dirname, join, relative, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { parseSync } from "vite";

const WEB = join(dirname(fileURLToPath(import.meta.url)), "..");
const SOURCES = join(WEB, "src");
const TEXTS = join(WEB, "texts");
/** The files of a language whose texts the code says; the others are the service's. */
const SAID_HERE = ["answering", "console", "notices"];
const OF_SERVICE = ["sentences", "clauses", "refusals", "reasons"];
const ALL_FILES = [...SAID_HERE, ...OF_SERVICE];
/** From these everything is loaded before a question can be answered, and before a notice is shown. */
const ANSWERING = ["begin.tsx", "question/queue_list.tsx"];
const NOTICES = "calling/notices.ts";

/** Attributes that people read or hear. */
const HEARD = new Set(["aria-label", "aria-valuetext", "aria-description", "alt", "title", "placeholder", "label"]);
const LETTERS = /\p{L}{2,}/u;
/** What is told people; what only developers read begins with a small letter. */
const SENTENCE = /^[A-Z0-9][^/]*( [a-z]+){2,}/;
/** What is called so in every language. */
const NAMES = new Set(["Mend", "mend site open SCENE --world building --fleet live"]);

export function problems() {
  const modules = sources().map(read);
  const here = domainsOf(modules);
  const languages = readdirSync(TEXTS).sort();
  const found = modules.flatMap(({ file, untold }) => untold.map((text) => `${file}: “${text}” is no text of the languages`));
  for (const language of languages) {
    const texts = Object.fromEntries(ALL_FILES.map((name) => [name, textsOf(language, name)]));
    for (const name of SAID_HERE) found.push(...compared(`${language}/${name}.json`, here[name], texts[name]));
    for (const name of ALL_FILES) found.push(...misfilled(language, `${language}/${name}.json`, texts[name]));
    for (const name of OF_SERVICE) {
      const first = Object.keys(textsOf(languages[0], name));
      found.push(...compared(`${language}/${name}.json`, new Set(first), texts[name]));
    }
  }
  return found;
}

function sources() {
  return readdirSync(SOURCES, { recursive: true })
    .map((name) => join(SOURCES, name))
    .filter((name) => /\.tsx?$/.test(name));
}

function textsOf(language, name) {
  const path = join(TEXTS, language, `${name}.json`);
  return existsSync(path) ? JSON.parse(readFileSync(path, "utf8")) : {};
}

/** What a module says, what it imports before it runs, and what it says in English alone. */
function read(path) {
  const { program } = parseSync(path, readFileSync(path, "utf8"));
  const module = { file: relative(SOURCES, path), says: new Set(), imports: [], untold: [] };
  for (const each of program.body) {
    const from = each.importKind === "type" || each.exportKind === "type" ? undefined : each.source?.value;
    if (from?.startsWith(".")) module.imports.push(relative(SOURCES, resolve(dirname(path), from)));
  }
  const texts = new Set();
  walk(program, (node) => {
    if (node.type === "CallExpression") said(node, module.says, texts);
    if (isSentence(node) && !texts.has(node)) module.untold.push(textOf(node));
    if (node.type === "JSXText") untold(node.value, module);
    if (node.type === "JSXAttribute" && HEARD.has(node.name.name)) {
      for (const text of literalsOf(node.value)) untold(text, module);
    }
  });
  return module;
}

function said({ callee, arguments: given }, says, texts) {
  if (!["t", "tn", "parts"].includes(callee.name)) return;
  const [key, one] = callee.name === "tn" ? [given[1], given[0]] : [given[0]];
  for (const text of literalsOf(key)) says.add(text);
  for (const each of [key, one]) if (each !== undefined) walk(each, (node) => texts.add(node));
}

function isSentence(node) {
  return SENTENCE.test(textOf(node) ?? "");
}

function textOf(node) {
  if (node.type === "Literal" && typeof node.value === "string") return node.value;
  return node.type === "TemplateElement" ? node.value.cooked : undefined;
}

function untold(text, module) {
  const words = text.trim();
  if (LETTERS.test(words) && !NAMES.has(words)) module.untold.push(words);
}

/** The texts that an expression may be by itself. */
function literalsOf(node) {
  switch (node?.type) {
    case "Literal":
      return typeof node.value === "string" ? [node.value] : [];
    case "ConditionalExpression":
      return [...literalsOf(node.consequent), ...literalsOf(node.alternate)];
    case "JSXExpressionContainer":
      return literalsOf(node.expression);
    default:
      return [];
  }
}

function walk(node, visit) {
  visit(node);
  for (const value of Object.values(node)) {
    for (const each of Array.isArray(value) ? value : [value]) {
      if (typeof each?.type === "string") walk(each, visit);
    }
  }
}

/** In which file of each language a text belongs: where it is there as soon as it is said. */
function domainsOf(modules) {
  const byName = new Map(modules.map((each) => [each.file.replace(/\.tsx?$/, ""), each]));
  const early = new Set();
  const follow = (module) => {
    if (module === undefined || early.has(module)) return;
    early.add(module);
    for (const name of module.imports) follow(byName.get(name));
  };
  for (const name of ANSWERING) follow(byName.get(name.replace(/\.tsx?$/, "")));
  const domains = { answering: new Set(), console: new Set(), notices: new Set() };
  const inNotices = byName.get(NOTICES.replace(/\.tsx?$/, "")).says;
  for (const text of inNotices) domains.notices.add(text);
  for (const { says } of early) for (const text of says) if (!inNotices.has(text)) domains.answering.add(text);
  for (const { says } of modules) {
    for (const text of says) if (!inNotices.has(text) && !domains.answering.has(text)) domains.console.add(text);
  }
  return domains;
}

function compared(file, wanted, texts) {
  const missing = [...wanted].filter((key) => !(key in texts)).map((key) => `${file} lacks “${key}”`);
  const unused = Object.keys(texts).filter((key) => !wanted.has(key));
  return [...missing, ...unused.map((key) => `${file} has “${key}”, which is said nowhere, or not from this file`)];
}

function misfilled(language, file, texts) {
  const forms = new Intl.PluralRules(language).resolvedOptions().pluralCategories;
  return Object.entries(texts).flatMap(([key, text]) => {
    const all = typeof text === "string" ? { other: text } : text;
    const lacking = typeof text === "string" ? [] : forms.filter((form) => !(form in all));
    // One may be said in words: "one run goes on".
    const wrong = Object.entries(all)
      .filter(([form, each]) => (form === "other" ? fieldsOf(each) !== fieldsOf(key) : !isWithin(each, key)))
      .map(([, each]) => each);
    return [
      ...lacking.map((form) => `${file}: “${key}” lacks the form “${form}”`),
      ...wrong.map((each) => `${file}: “${each}” has not the fields of “${key}”`),
    ];
  });
}

function fieldsOf(text) {
  return [...new Set(text.match(/\{\w+\}/g))].sort().join(" ");
}

function isWithin(text, key) {
  return (text.match(/\{\w+\}/g) ?? []).every((field) => key.includes(field));
}

if (import.meta.url === pathToFileURL(process.argv[1] ?? "").href) {
  const found = problems();
  for (const each of found) console.error(each);
  process.exitCode = found.length > 0 ? 1 : 0;
}
