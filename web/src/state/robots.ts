// The robots that the service knows, read anew whenever one comes or goes.
import { computed, signal } from "@preact/signals";
import * as rest from "../wire/rest";
import type { Event, RobotView } from "../wire/types";
import { onEvent, onSnapshot, runs } from "./service";

const COMES_OR_GOES: ReadonlySet<Event["type"]> = new Set([
  "robot_lost",
  "robot_back",
  "run_started",
  "run_finished",
  "run_failed",
  "run_aborted",
]);

/** None where this helper may not see them. */
export const robots = signal<readonly RobotView[]>([]);

/** Those that are gone while a run that goes on waits for them. */
export const lostRobots = computed(() =>
  robots.value.filter(({ state, run }) => {
    const status = run === null ? undefined : runs.value.get(run)?.status;
    return state === "lost" && (status === "running" || status === "paused");
  }),
);

export async function readRobots(): Promise<void> {
  robots.value = await rest.robots();
}

const read = () => void readRobots().catch(() => undefined);

export function followRobots(): () => void {
  const stop = [onSnapshot(read), onEvent((event) => COMES_OR_GOES.has(event.type) && read())];
  read();
  return () => stop.forEach((each) => each());
}
