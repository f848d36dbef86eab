// What rings here, and how often: until somebody is on it, or whoever is called puts it off.
import type { Question, Together } from "../state/questions";
import { isTurnOf } from "../question/turn";
import type { RobotView } from "../wire/types";

/** One thing that this helper is called about. */
export interface Ring {
  /** What is told once: a question, to anybody or to the helper whose turn has come. */
  key: string;
  /** The robot does not wait: help is needed now. */
  urgent: boolean;
}

/** A robot that is gone while a run waits for it: it calls everybody who helps. */
type Lost = Pick<RobotView, "robot" | "run">;

type Asked = Pick<Question, "prompt" | "claimed_by" | "interrupts">;

/** What rings for this helper; `putOff` are prompts that they do not want to be called about here. */
export function ringing(
  open: readonly Asked[],
  together: readonly Pick<Together, "prompt" | "helper">[],
  me: string,
  putOff: ReadonlySet<string>,
  lost: readonly Lost[] = [],
): Ring[] {
  const asked = open
    .filter((each) => isTurnOf(me, each) && each.claimed_by === null && !putOff.has(each.prompt?.prompt ?? ""))
    .map((each) => ({ key: ringOf(each), urgent: !each.interrupts }));
  const held = together
    .filter((each) => each.helper === me && !putOff.has(each.prompt))
    .map((each) => ({ key: each.prompt, urgent: true }));
  const gone = lost.map((each) => ({ key: ringOfLost(each), urgent: false })).filter(({ key }) => !putOff.has(key));
  return [...held, ...asked, ...gone];
}

export function ringOfLost({ robot, run }: Lost): string {
  return `lost ${robot} ${run}`;
}

export function ringOf({ prompt }: Pick<Question, "prompt">): string {
  return `${prompt?.prompt} ${prompt?.to ?? null}`;
}

const CALM_MS = [6_000, 12_000, 20_000, 30_000, 45_000, 60_000];
const URGENT_MS = [2_500, 2_500, 4_000, 6_000];

/** How long after so many rings the next one comes: soon at first, then now and then. */
export function pauseAfter(rings: number, urgent: boolean): number {
  const pauses = urgent ? URGENT_MS : CALM_MS;
  return pauses[Math.min(rings, pauses.length) - 1] ?? pauses[0] ?? 0;
}

/** What makes itself heard, and a timer; passed in, so that no test waits. */
export interface Bell {
  ring(urgent: boolean): void;
  later(ms: number, then: () => void): () => void;
}

/** Rings at once for what is new, then again and again until nothing is left. */
export class Ringer {
  #rings: readonly Ring[] = [];
  #known = new Set<string>();
  #rung = 0;
  #stop: () => void = () => undefined;

  constructor(private readonly bell: Bell) {}

  /** From now on this rings, and nothing else. */
  set(rings: readonly Ring[]): void {
    const fresh = rings.some(({ key }) => !this.#known.has(key));
    this.#known = new Set(rings.map(({ key }) => key));
    this.#rings = rings;
    if (rings.length === 0) this.#stop();
    if (!fresh) return;
    this.#rung = 0;
    this.#ring();
  }

  #ring(): void {
    this.#stop();
    if (this.#rings.length === 0) return;
    const urgent = this.#rings.some((each) => each.urgent);
    this.bell.ring(urgent);
    this.#rung += 1;
    this.#stop = this.bell.later(pauseAfter(this.#rung, urgent), () => this.#ring());
  }
}
