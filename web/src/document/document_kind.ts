// What differs between the files that can be edited here: task trees and scenes.
import type { DocumentCheck, DocumentSummary, DocumentView } from "../wire/types";

export interface DocumentKind {
  /** What one is called in a sentence. */
  said: string;
  newName: string;
  newText: string;
  /** What the text of one is called for those who hear it. */
  textLabel: string;
  /** Its draft's name. */
  draftOf: (name: string | null) => string | null;
  /** The page that shows one, or all. */
  addressOf: (name: string | null) => string;
  list: () => Promise<readonly DocumentSummary[]>;
  read: (name: string) => Promise<DocumentView>;
  check: (text: string, signal: AbortSignal) => Promise<DocumentCheck>;
  save: (text: string, name: string) => Promise<{ name: string }>;
}
