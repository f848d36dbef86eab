// What the check says of a text, at the nodes that it is about.
import type { Checked } from "../../document/checked";
import { offsetOfLine } from "../../yaml_text/splice";
import { sameValue } from "../../yaml_text/values";
import { nodeAt } from "./plain_node";
import { nodeAtOffset, readTask, type TaskSource } from "./task_source";

/** The sentences by path; of a text that was not checked yet those of nodes that are as they were. */
export function nodeProblems(now: TaskSource, { check, text }: Checked): ReadonlyMap<string, readonly string[]> {
  const found = new Map<string, string[]>();
  if (check === null || check.errors.length === 0) return found;
  const source = text === now.text ? now : readTask(text);
  if (source === null) return found;
  for (const { node, line, message } of check.errors) {
    const path = node ?? (line === null ? null : nodeAtOffset(source, offsetOfLine(text, line) + indentation(text, line)));
    if (path === null || !sameValue(nodeAt(source.tree, path), nodeAt(now.tree, path))) continue;
    found.set(path, [...(found.get(path) ?? []), message]);
  }
  return found;
}

function indentation(text: string, line: number): number {
  return /^[ ]*(?:- )?/.exec(text.slice(offsetOfLine(text, line)))?.[0].length ?? 0;
}
