// What the check says of a scene, at the things that it is about.
import type { Checked } from "../document/checked";
import { lineEnd, offsetOfLine } from "../yaml_text/splice";
import { sameValue } from "../yaml_text/values";
import { readScene, type SceneSource, type Span, type Thing } from "./scene_source";
import { t } from "../words/words";

export interface ThingProblem {
  message: string;
  /** Whether it is a mistake, and not only what one of several worlds cannot do. */
  mistake: boolean;
}

/** The key of a thing among those of its scene. */
export function keyOf({ kind, name }: Pick<Thing, "kind" | "name">): string {
  return `${kind}:${name}`;
}

/** By `keyOf`; of a text that was not checked yet those of things that are where they were. */
export function thingProblems(now: SceneSource, { check, text }: Checked): ReadonlyMap<string, readonly ThingProblem[]> {
  const found = new Map<string, ThingProblem[]>();
  const source = check === null ? null : text === now.text ? now : readScene(text);
  if (check === null || source === null) return found;
  const present = new Map(now.things.map((thing) => [keyOf(thing), thing]));
  for (const { line, ...problem } of problemsOf(check)) {
    for (const thing of line === null ? [] : thingsAt(source, line, problem.message)) {
      if (!sameValue(present.get(keyOf(thing))?.pose, thing.pose)) continue;
      found.set(keyOf(thing), [...(found.get(keyOf(thing)) ?? []), problem]);
    }
  }
  return found;
}

type Told = ThingProblem & { line: number | null };

function problemsOf({ errors, worlds }: NonNullable<Checked["check"]>): Told[] {
  const mistakes = errors.map(({ line, message }) => ({ line, message, mistake: true }));
  if (mistakes.length > 0) return mistakes;
  return worlds.flatMap(({ world, problems }) =>
    problems.map(({ line, message }) => ({
      line,
      message: t("in the world '{world}': {message}", { world, message }),
      mistake: false,
    })),
  );
}

/** The things that a line is of, and of several those that the sentence names. */
function thingsAt({ text, things }: SceneSource, line: number, message: string): Thing[] {
  const from = offsetOfLine(text, line);
  const to = lineEnd(text, from);
  const within = (span: Span | null) => span !== null && span[0] < to && span[1] > from;
  const own = things.filter(({ span }) => within(span));
  const there = own.length > 0 ? own : things.filter(({ entry }) => within(entry));
  const words = new Set(message.match(/[\w-]+/g));
  const named = there.filter(({ name }) => words.has(name));
  return named.length > 0 ? named : there;
}
