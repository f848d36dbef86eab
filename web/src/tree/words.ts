// The words for what a task tree shows.
import type { NodeKind, NodeState, TreeNode } from "./tree_node";

export const KIND_WORDS: Readonly<Record<NodeKind, string>> = {
  then: "THEN",
  and: "AND",
  or: "OR",
  behavior: "behavior",
};

/** What has to be done of the children. */
export const KIND_RULES: Readonly<Record<Exclude<NodeKind, "behavior">, string>> = {
  then: "all, in this order",
  and: "all, in any order",
  or: "exactly one",
};

export const KIND_MEANINGS: Readonly<Record<NodeKind, string>> = {
  then: `THEN, ${KIND_RULES.then}`,
  and: `AND, ${KIND_RULES.and}`,
  or: `OR, ${KIND_RULES.or}`,
  behavior: "behavior",
};

export const STATE_WORDS: Readonly<Record<NodeState, string>> = {
  waiting: "waiting",
  eligible: "eligible",
  active: "active",
  in_dialogue: "in dialogue",
  done: "done",
  abandoned: "abandoned",
  failed: "failed",
  left: "not done",
};

/** The word under a node: who does what is active, where that is a person. */
export function stateWord(node: TreeNode, state: NodeState): string {
  if (node.steered?.waits === true) return "waits";
  if (node.steered?.next === true && state === "eligible") return "next";
  return node.byPerson ? "a person" : STATE_WORDS[state];
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
  if (node.owner !== null) parts.push(`${node.byPerson ? "being done" : "held"} by ${node.owner}`);
  if (node.steered?.breakpoint === true) parts.push("a breakpoint before it");
  if (node.steered?.waits === true) parts.push("waits to be let go");
  if (node.steered?.next === true) parts.push("asked for next");
  if (node.level !== null) parts.push(`level ${node.level.toFixed(2)}`);
  if (node.potential !== null) parts.push(`potential ${node.potential.toFixed(2)}`);
  if (node.attempts > 0) parts.push(`${node.attempts} failed`);
  if (hidden > 0) parts.push(`${hidden} nodes under it are folded away`);
  if (leftOut > 0) parts.push(`${leftOut} of its children are not drawn`);
  const told = parts.join(", ");
  return problem === undefined ? told : `${told}. Mistake: ${problem}`;
}
