// Which language this page speaks: the one chosen on this device, else the first of the browser's that there is.

/** Those that there are texts in, as the build has found them. */
declare const LANGUAGES: readonly string[];

export const languages = LANGUAGES;

export const CHOSEN_AS = "mend.language";

export const language = languageOf(chosen(), navigator.languages, languages);

/** For numbers, times and lists: how the reader's country writes them, where the browser says so. */
export const locale = language === "en" ? "en-GB" : (navigator.languages.find((each) => baseOf(each) === language) ?? language);

/** `chosen` is empty where the browser's wish is followed. */
export function languageOf(chosen: string, wished: readonly string[], known: readonly string[]): string {
  return [chosen, ...wished.map(baseOf)].find((each) => known.includes(each)) ?? "en";
}

/** What a language is called, by those who speak it unless told otherwise. */
export function nameOf(language: string, by = language): string {
  return new Intl.DisplayNames([by], { type: "language" }).of(language) ?? language;
}

function baseOf(tag: string): string {
  return tag.split("-")[0]?.toLowerCase() ?? "";
}

function chosen(): string {
  try {
    return JSON.parse(localStorage.getItem(CHOSEN_AS) ?? '""') as string;
  } catch {
    // Where nothing is kept, as in a test, nothing is chosen.
    return "";
  }
}
