// Between two readings robots are drawn on their way from one place to the next.
import { useEffect, useRef } from "preact/hooks";
import type { Positions } from "../building/use_robots";

const GLIDE_MS = 900;
/** Who has come farther than this is drawn there at once: the way between may lead round something. */
const FARTHEST_M = 2.5;

/** What is not `live` has the places between as well. */
export function useGliding(positions: Positions, live: boolean, draw: (positions: Positions) => void): void {
  const shown = useRef<Positions>(new Map());
  const show = useRef(draw);
  show.current = draw;
  useEffect(() => {
    const from = shown.current;
    const began = performance.now();
    const atOnce = !live || matchMedia("(prefers-reduced-motion: reduce)").matches;
    let frame = 0;
    const pass = (now: number) => {
      const share = atOnce ? 1 : Math.min(1, Math.max(0, (now - began) / GLIDE_MS));
      shown.current = between(from, positions, share);
      show.current(shown.current);
      if (share < 1) frame = requestAnimationFrame(pass);
    };
    pass(began);
    return () => cancelAnimationFrame(frame);
  }, [positions]);
  // What is drawn anew by others lacks the robots.
  useEffect(() => show.current(shown.current));
}

function between(from: Positions, to: Positions, share: number): Positions {
  return new Map(
    [...to].map(([robot, there]) => {
      const here = from.get(robot);
      if (here === undefined || Math.hypot(there.x - here.x, there.y - here.y) + Math.abs(there.z - here.z) > FARTHEST_M) {
        return [robot, there] as const;
      }
      const on = (a: number, b: number) => a + (b - a) * share;
      const turn = Math.atan2(Math.sin(there.yaw - here.yaw), Math.cos(there.yaw - here.yaw));
      return [robot, { ...there, x: on(here.x, there.x), y: on(here.y, there.y), yaw: here.yaw + turn * share }] as const;
    }),
  );
}
