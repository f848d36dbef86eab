// The words for what a task tree shows.
import type { NodeKind, NodeState, TreeNode } from "./tree_node";
import { decimal, t } from "../words/words";

export const KIND_WORDS: Readonly<Record<NodeKind, string>> = {
  then: "THEN",
  and: "AND",
  or: "OR",
  behavior: t("behavior"),
};

/** What has to be done of the children. */
export const KIND_RULES: Readonly<Record<Exclude<NodeKind, "behavior">, string>> = {
  then: t("all, in this order"),
  and: t("all, in any order"),
  or: t("exactly one"),
};

export const KIND_MEANINGS: Readonly<Record<NodeKind, string>> = {
  then: `THEN, ${KIND_RULES.then}`,
  and: `AND, ${KIND_RULES.and}`,
  or: `OR, ${KIND_RULES.or}`,
  behavior: t("behavior"),
};

export const STATE_WORDS: Readonly<Record<NodeState, string>> = {
  waiting: t("waiting"),
  eligible: t("eligible"),
  active: t("active"),
  in_dialogue: t("in dialogue"),
  done: t("done"),
  abandoned: t("abandoned"),
  failed: t("failed"),
  left: t("not done|as a node’s state"),
};

/** The word under a node: who does what is active, where that is a person. */
export function stateWord(node: TreeNode, state: NodeState): string {
  if (node.steered?.waits === true) return t("waits");
  if (node.steered?.next === true && state === "eligible") return t("next|as a node’s state");
  return node.byPerson ? t("a person") : STATE_WORDS[state];
}

/** A name as people write it. */
export function plain(name: string): string {
  return name.replaceAll("_", " ");
}

/** A robot's name within its run, whose number those of simulated worlds end with. */
export function withoutRun(robot: string): string {
  return robot.replace(/-[0-9a-f]{8}$/, "");
}

/** What is left of a text where only so many characters have room. */
export function shortened(text: string, characters: number): string {
  if (text.length <= characters) return text;
  // A letter or two of a name says nothing.
  return characters < 4 ? "" : `${text.slice(0, characters - 1)}…`;
}

/** Everything about a node in one sentence, for those who hear the drawing. */
export function described(node: TreeNode, hidden: number, leftOut: number, problem?: string): string {
  const parts = [plain(node.name), KIND_MEANINGS[node.kind]];
  if (node.behavior !== null) parts[1] = plain(node.behavior);
  if (node.state !== null) parts.push(STATE_WORDS[node.state]);
  if (node.owner !== null)
    parts.push(node.byPerson ? t("being done by {owner}", { owner: node.owner }) : t("held by {owner}", { owner: node.owner }));
  if (node.steered?.breakpoint === true) parts.push(t("a breakpoint before it"));
  if (node.steered?.waits === true) parts.push(t("waits to be let go"));
  if (node.steered?.next === true) parts.push(t("asked for next"));
  if (node.level !== null) parts.push(t("level {level}", { level: decimal(node.level, 2) }));
  if (node.potential !== null) parts.push(t("potential {potential}", { potential: decimal(node.potential, 2) }));
  if (node.attempts > 0) parts.push(t("{count} failed", { count: node.attempts }));
  if (hidden > 0) parts.push(t("{count} nodes under it are folded away", { count: hidden }));
  if (leftOut > 0) parts.push(t("{count} of its children are not drawn", { count: leftOut }));
  const told = parts.join(", ");
  return problem === undefined ? told : t("{told}. Mistake: {problem}", { told, problem });
}
