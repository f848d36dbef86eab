// What stands on the lanes of a run's timeline.
import { plain, withoutRun } from "../../tree/words";
import type { DialogueClosed, Event, NodeDone, NodeLeftOut, NodeReset, Resolution, RobotBack } from "../../wire/types";
import type { Told } from "../../wire/told";
import { lastOf } from "../transcript_lines";
import { issueKind } from "../../words/issue_kinds";
import { said } from "../../words/said";
import { t } from "../../words/words";

export type LaneKind = "steps" | "faults" | "lost" | "dialogues" | "people" | "waits" | "resolutions";

/** One thing on a lane; `start` equals `end` for what takes no time. Seconds of the run's clock. */
export interface TimelineItem {
  /** The event that it begins with. */
  seq: number;
  start: number;
  end: number;
  /** The words on it, where they have room. */
  word: string;
  /** What it is, in full. */
  title: string;
  look: string;
  node: string | null;
  parts: readonly TimelineItem[];
}

export interface Lane {
  kind: LaneKind;
  name: string;
  items: readonly TimelineItem[];
}

export const RESOLUTION_WORDS: Readonly<Record<Resolution, string>> = {
  human_finish: t("human finished"),
  robot_finish: t("robot goes on"),
  collab_finish: t("both finish"),
  robot_retry: t("tries again"),
};

const STEERING_WORDS = {
  breakpoint_set: t("breakpoint"),
  breakpoint_removed: t("no breakpoint"),
  leaf_let_go: t("go on"),
  leaf_preferred: t("next"),
  leaf_not_preferred: t("not next"),
  leaf_tried_again: t("again"),
} as const;

/** What people do in a world, in a word or two. */
const ACT_WORDS: Readonly<Record<string, string>> = {
  steal: t("takes away|a deed on the timeline"),
  put_back: t("puts back|a deed on the timeline"),
  place: t("places|a deed on the timeline"),
  hand_over: t("hands over|a deed on the timeline"),
  move: t("moves|a deed on the timeline"),
  block: t("in the way|a deed on the timeline"),
  release: t("helps on|a deed on the timeline"),
  cover: t("covers camera|a deed on the timeline"),
  uncover: t("clears camera|a deed on the timeline"),
  put_in: t("puts in|a deed on the timeline"),
  take_out: t("takes out|a deed on the timeline"),
  charge: t("plugs in|a deed on the timeline"),
  bar: t("bars way|a deed on the timeline"),
  clear: t("clears way|a deed on the timeline"),
  send_person: t("sends person|a deed on the timeline"),
  misdirect: t("wrong button|a deed on the timeline"),
};

/** How a dialogue ended. */
const CLOSING_WORDS: Readonly<Record<DialogueClosed["reason"], string>> = {
  resolved: t("resolved|a dialogue"),
  withdrawn: t("withdrawn|a dialogue"),
  gave_up: t("given up|a dialogue"),
  left_out: t("left out"),
  aborted: t("lapsed|a dialogue"),
};

const ENDS_A_WAIT: ReadonlySet<Event["type"]> = new Set([
  "leaf_let_go",
  "leaf_tried_again",
  "node_started",
  "node_taken",
  "node_left_out",
]);

const ENDS_ALL_WAITS: ReadonlySet<Event["type"]> = new Set([
  "breakpoint_removed",
  "autonomy_set",
  "run_finished",
  "run_failed",
  "run_aborted",
]);

const ENDINGS = {
  node_done: ["done", t("done")],
  node_left_out: ["put-back", t("left out")],
  node_reset: ["put-back", t("put back")],
} as const;

interface Growing extends TimelineItem {
  parts: Growing[];
}

/** The lanes of a run's first `count` events; what goes on still ends at `now`. */
export function lanesOf(events: readonly Told[], now: number): Lane[] {
  const started = events[0];
  if (started?.type !== "run_started") return [];
  const steps = new Map<string, Growing[]>(started.robots.map((robot) => [robot, []]));
  const lanes: Record<Exclude<LaneKind, "steps">, Growing[]> = {
    faults: [],
    lost: [],
    dialogues: [],
    people: [],
    waits: [],
    resolutions: [],
  };
  const running = new Map<string, Growing>();
  const open = new Map<string, Growing>();
  const away = new Map<string, Growing>();
  const held = new Map<string, Growing>();
  for (const event of events) {
    endWaits(held, event);
    switch (event.type) {
      case "breakpoint_set":
      case "breakpoint_removed":
      case "leaf_let_go":
      case "leaf_preferred":
      case "leaf_not_preferred":
      case "leaf_tried_again":
        lanes.people.push(point(event, STEERING_WORDS[event.type], `${event.by} ${lastOf(event)}`, "deed", event.node));
        break;
      case "autonomy_set":
        lanes.people.push(point(event, t("autonomy {level}", { level: event.level }), `${event.by} ${lastOf(event)}`, "deed", null));
        break;
      case "leaf_held": {
        const item = bar(event, now, plain(event.name), lastOf(event), "held", event.node);
        held.set(event.node, item);
        lanes.waits.push(item);
        break;
      }
      case "node_started": {
        const name = plain(event.name);
        const item = bar(event, now, name, t("{name}, attempt {attempt}", { name, attempt: event.attempt }), "execution", event.node);
        running.set(event.node, item);
        steps.get(event.robot)?.push(item);
        break;
      }
      case "step_started": {
        const parts = running.get(event.node)?.parts;
        closePart(parts, event.time);
        const word = `${event.step} ${plain(event.step_name)}`;
        parts?.push(bar(event, now, word, t("step {word} of {name}", { word, name: plain(event.name) }), "step", event.node));
        break;
      }
      case "node_done":
      case "node_left_out":
      case "node_reset":
        endExecution(running, event);
        break;
      case "node_taken":
        lanes.people.push(point(event, t("takes|a person, a leaf"), t("{helper} takes {name}", { helper: event.helper, name: plain(event.name) }), "deed", event.node));
        break;
      case "node_undone":
        lanes.faults.push(point(event, issueKind("undone"), t("{name} is done no longer: {reason}", { name: plain(event.name), reason: said(event.reason) }), "fault", event.node));
        break;
      case "issue_raised": {
        const about = plain(event.object ?? event.name);
        lanes.faults.push(point(event, issueKind(event.issue), `${issueKind(event.issue)}, ${about}`, "fault", event.node));
        break;
      }
      case "robot_lost": {
        const robot = withoutRun(event.robot);
        if (away.has(event.robot)) break;
        const item = bar(event, now, robot, t("{robot} is lost: {reason}", { robot, reason: said(event.reason) }), "lost", null);
        away.set(event.robot, item);
        lanes.lost.push(item);
        break;
      }
      case "robot_back":
        comeBack(away, event);
        break;
      case "run_finished":
      case "run_failed":
      case "run_aborted":
        for (const item of away.values()) item.end = event.time;
        break;
      case "dialogue_opened": {
        const title = t("dialogue about {issue}, {part}", { issue: issueKind(event.issue), part: plain(event.object ?? event.name) });
        const item = bar(event, now, plain(event.object ?? event.name), title, "dialogue", event.node);
        open.set(event.dialogue, item);
        lanes.dialogues.push(item);
        break;
      }
      case "dialogue_closed":
        closeDialogue(open, event);
        break;
      case "intervention":
        lanes.people.push(
          point(
            event,
            ACT_WORDS[event.act] ?? plain(event.act),
            `${event.by}: ${lastOf(event)}`,
            event.ok ? "deed" : "deed vain",
            null,
          ),
        );
        break;
      case "resolved": {
        const word = RESOLUTION_WORDS[event.resolution];
        lanes.resolutions.push(point(event, word, `${plain(event.name)}: ${word}`, "resolution", event.node));
        break;
      }
      default:
        break;
    }
  }
  const several = started.robots.length > 1;
  return [
    ...[...steps].map(([robot, items]): Lane => ({ kind: "steps", name: several ? robot : t("Steps"), items })),
    { kind: "faults", name: t("Faults"), items: lanes.faults },
    ...(lanes.lost.length > 0 ? [{ kind: "lost", name: t("Robot lost"), items: lanes.lost } as const] : []),
    { kind: "dialogues", name: t("Dialogues"), items: lanes.dialogues },
    { kind: "people", name: t("People"), items: lanes.people },
    ...(lanes.waits.length > 0 ? [{ kind: "waits", name: t("Waits"), items: lanes.waits } as const] : []),
    { kind: "resolutions", name: t("Resolutions"), items: lanes.resolutions },
  ];
}

/** What ends that a robot waits before a leaf; whoever still has a reason to wait says so anew. */
function endWaits(held: Map<string, Growing>, event: Told): void {
  const all = ENDS_ALL_WAITS.has(event.type);
  if (!all && !ENDS_A_WAIT.has(event.type)) return;
  for (const [node, item] of held) {
    if (!all && (!("node" in event) || event.node !== node)) continue;
    item.end = event.time;
    held.delete(node);
  }
}

function bar(event: Event, end: number, word: string, title: string, look: string, node: string | null): Growing {
  return { seq: event.seq, start: event.time, end: Math.max(end, event.time), word, title, look, node, parts: [] };
}

function point(event: Event, word: string, title: string, look: string, node: string | null): Growing {
  return bar(event, event.time, word, title, look, node);
}

function closePart(parts: Growing[] | undefined, time: number): void {
  const last = parts?.at(-1);
  if (last !== undefined) last.end = time;
}

function endExecution(running: Map<string, Growing>, event: NodeDone | NodeLeftOut | NodeReset): void {
  const item = running.get(event.node);
  if (item === undefined) return;
  running.delete(event.node);
  closePart(item.parts, event.time);
  item.end = event.time;
  const [look, word] = ENDINGS[event.type];
  item.look = `execution ${look}`;
  item.title += `, ${word}`;
}

function closeDialogue(open: Map<string, Growing>, event: DialogueClosed): void {
  const item = open.get(event.dialogue);
  if (item === undefined) return;
  open.delete(event.dialogue);
  item.end = event.time;
  item.title += `, ${CLOSING_WORDS[event.reason]}`;
}

function comeBack(away: Map<string, Growing>, event: RobotBack): void {
  const item = away.get(event.robot);
  if (item === undefined) return;
  away.delete(event.robot);
  item.end = event.time;
  item.title += t(", and back");
}

/** From so many seconds on people count in minutes and hours. */
const LEAST_ROUND_S = 10;
const ROUND_S = [10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 14_400, 28_800, 86_400];

/** Times for the axis, so far apart that their words do not touch. */
export function ticksOf(from: number, to: number, atMost: number): number[] {
  const least = (to - from) / Math.max(atMost, 1);
  const magnitude = 10 ** Math.floor(Math.log10(Math.max(least, 0.01)));
  const decimal = ([1, 2, 5, 10].find((factor) => factor * magnitude >= least) ?? 10) * magnitude;
  const every = decimal < LEAST_ROUND_S ? decimal : (ROUND_S.find((each) => each >= least) ?? decimal);
  const ticks: number[] = [];
  for (let index = Math.ceil(from / every); index * every <= to; index++) ticks.push(index * every);
  return ticks;
}
