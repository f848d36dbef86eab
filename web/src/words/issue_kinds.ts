// What kinds of issue are called in the reader's language: the service knows them by English names.
import { translated } from "./said";

/** A kind that nobody has put into that language is called as the service calls it. */
export function issueKind(issue: string): string {
  const plain = issue.replaceAll("_", " ");
  return translated(plain) ?? plain;
}

/** What somebody looks for: the service's name of a kind of issue where they said the reader's. */
export function issueMeant(text: string, kinds: Iterable<string>): string {
  const said = text.trim().toLowerCase();
  for (const kind of kinds) if (issueKind(kind).toLowerCase() === said) return kind.replaceAll("_", " ");
  return text;
}
