// A task file from this device: saved if it is right, and opened in the editor if it is not.
import { go } from "../app/router";
import * as rest from "../wire/rest";
import type { DocumentSummary } from "../wire/types";
import { keepDraft } from "../document/draft";
import { freeName, nameIn, nameOfFile, renamed } from "./tree_text";
import { t, tn } from "../words/words";

const LARGEST_BYTES = 8 * 1024 * 1024;

/** A file that is no task file at all. */
export class NotATaskFile extends Error {}

/**
 * Take a file in, and show what came of it: the tree, or its text in the editor.
 *
 * Raises `NotATaskFile`, and `Refusal` or `Unreachable` where the service did not take it.
 */
export async function takeFile(file: File, trees: readonly DocumentSummary[]): Promise<void> {
  const text = await textOf(file);
  const check = await rest.checkTree(text, new AbortController().signal);
  const name = check.name ?? nameIn(text) ?? nameOfFile(file.name);
  if (check.errors.length > 0) {
    const count = check.errors.length === 1 ? t("a mistake") : tn("{count} mistake", "{count} mistakes", { count: check.errors.length });
    edit(name, text, t("{name} has {count} and is not saved yet. Put it right here.", { name: file.name, count }));
    return;
  }
  if (trees.some((each) => each.name === name)) {
    const other = freeName(name, new Set(trees.map((each) => each.name)));
    edit(
      other,
      renamed(text, other),
      t("There is a tree '{name}' already, so {file} is called '{other}' here. It is not saved yet.", {
        name,
        file: file.name,
        other,
      }),
    );
    return;
  }
  await rest.saveTree(text, name);
  go(`/trees/${name}`);
}

function edit(name: string, text: string, note: string): void {
  keepDraft(null, { text, name, note });
  go("/edit");
}

async function textOf(file: File): Promise<string> {
  if (file.size > LARGEST_BYTES) {
    throw new NotATaskFile(t("{name} is larger than 8 MiB; a task file may not be.", { name: file.name }));
  }
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(await file.arrayBuffer());
  } catch {
    throw new NotATaskFile(t("{name} is no text in UTF-8; a task file is YAML or JSON.", { name: file.name }));
  }
}
