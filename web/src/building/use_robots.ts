// Follows the robots of a run: where they are is drawn with the frames, what is said of them changes rarely.
import { useEffect, useRef, useState } from "preact/hooks";
import type { Moment } from "../run/moment";
import type { PoseSource } from "../run/scene/pose_source";
import type { AtWork } from "./at_work";
import type { Plan } from "./plan";
import { type SeenRobot, seenRobots } from "./seen_robots";
import { createStandings, OLD_S, type Shown, type Standing } from "./standing";

const SAID_EVERY_MS = 250;
const CALM_MS = 1_000;
/** Frames come at least so often, s of the run's clock; so many of them may be left out. */
const FRAME_S = 0.05;
const LEFT_OUT = 4;
/** The first frame of a connection may be an old one; by now another one has come, or it is. */
const FIRST_S = 1;

export type Positions = ReadonlyMap<string, Standing>;

interface Followed {
  readonly source: PoseSource;
  readonly moment: Moment;
  readonly plan: Plan;
  readonly robots: readonly AtWork[];
  readonly speed: number | "max";
  readonly paused: boolean;
}

/** What is to be said of the robots; `draw` is called with where they are whenever that has changed. */
export function useRobots(followed: Followed, draw: (positions: Positions) => void): readonly SeenRobot[] {
  const [seen, setSeen] = useState<readonly SeenRobot[]>([]);
  const latest = useRef({ followed, draw });
  latest.current = { followed, draw };
  const look = useRef(() => {});
  const { source } = followed;
  useEffect(() => {
    const standings = createStandings();
    const calm = matchMedia("(prefers-reduced-motion: reduce)");
    const opened = performance.now();
    let frame = 0;
    let timer = 0;
    let said = -Infinity;
    let told = "";

    const pass = (now: number) => {
      frame = timer = 0;
      const { followed: about, draw: show } = latest.current;
      const found = standings.at(source.known(now), shownOf(about, now, opened));
      const names = source.layout.peek()?.robots ?? [];
      const ofRobots = about.robots.map(({ robot }) => found[names.indexOf(robot)] ?? null);
      show(new Map(about.robots.flatMap(({ robot }, index) => (ofRobots[index] ? [[robot, ofRobots[index]]] : []))));
      if (now - said >= SAID_EVERY_MS) {
        said = now;
        const atLeast = about.moment.live.peek() && source.heard() === null;
        const next = seenRobots(about.robots, ofRobots, { plan: about.plan, past: !about.moment.live.peek(), atLeast });
        const text = JSON.stringify(next);
        if (text !== told) setSeen(next);
        told = text;
      }
      if (source.moving(now)) soon();
    };
    const soon = () => {
      if (frame !== 0 || timer !== 0) return;
      if (calm.matches) timer = window.setTimeout(() => pass(performance.now()), CALM_MS);
      else frame = requestAnimationFrame(pass);
    };
    look.current = soon;
    source.onChange(soon);
    // What is not heard of grows older, and what was said too soon is said later.
    const ticking = window.setInterval(soon, CALM_MS / 2);
    soon();
    return () => {
      window.clearInterval(ticking);
      window.clearTimeout(timer);
      cancelAnimationFrame(frame);
      source.onChange(() => {});
    };
  }, [source]);
  useEffect(() => look.current(), [followed.robots]);
  return seen;
}

function shownOf({ source, moment, speed, paused }: Followed, now: number, opened: number): Shown {
  if (!moment.live.peek()) return { time: moment.time.peek(), silent_s: 0, old_s: OLD_S };
  const heard = source.heard();
  const slow = speed === "max" ? 0 : (LEFT_OUT * FRAME_S) / speed;
  const there = source.state.peek() === "watching";
  const time = source.known(now)?.time ?? 0;
  // While a run pauses nothing moves, and no time passes in a simulated world.
  if (paused && there) return { time, silent_s: 0, old_s: OLD_S };
  const old_s = Math.max(heard === null ? FIRST_S : OLD_S, slow);
  return { time, silent_s: Math.max(0, now - (heard ?? opened)) / 1000, old_s: there ? old_s : 0 };
}
