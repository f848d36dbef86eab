// The transcript of a run: each event as the lines that a person reads.
import type { Act, Author, Change, CloseReason, Event, Help, Intervention, MissingPart, NodeStarted, Resolution, RunFinished } from "../wire/types";
import { plain } from "../tree/words";

/** What kind of news a line brings; each has its own look. */
export type Tone =
  | "run"
  | "choice"
  | "step"
  | "fault"
  | "said"
  | "asked"
  | "answered"
  | "watched"
  | "deed"
  | "resolved"
  | "done"
  | "setback"
  | "finished"
  | "failed";

export interface Line {
  seq: number;
  time: number;
  /** Who acts or speaks; empty for the run itself. */
  speaker: string;
  text: string;
  tone: Tone;
  /** Lines of the same thread that follow each other are one. */
  thread?: string;
}

const DEEDS: Readonly<Record<Act, string>> = {
  steal: "takes {object} away",
  put_back: "puts {object} back",
  place: "puts {object} to its place",
  hand_over: "hands {object} over",
  move: "moves {object}",
  block: "stands in the arm's way",
  release: "gets out of the arm's way",
  cover: "covers the head camera",
  uncover: "clears the head camera's view",
};

const PROMISES: Readonly<Record<Help, string>> = {
  place: "{object} at its place",
  put_back: "{object} back within reach",
  hand_over: "{object} between the fingers",
  clear_way: "the way clear",
  clear_view: "the table again",
};

const RESOLUTIONS: Readonly<Record<Resolution, string>> = {
  human_finish: "the human finished {object}",
  robot_finish: "the robot goes on with {object}",
  collab_finish: "both finish {object} together",
  robot_retry: "the robot will try {object} again",
};

const CLOSINGS: Readonly<Partial<Record<CloseReason, string>>> = {
  withdrawn: "the question is withdrawn: by what the robot sees it is put right",
  gave_up: "the question is given up: no help was seen",
  aborted: "the question lapses: it no longer matters",
};

const DOERS = {
  robot: " by the robot",
  human: " by the human",
  both: " by robot and human together",
  found: ": the robot found it in place",
} as const;

const CHANGES: Readonly<Record<Change, string>> = {
  unknown: "",
  none: ", as it was before",
  appeared: ": it has come back",
  moved: ": it has been moved",
  handed_over: "",
  cleared: "",
};

/** What a person does, as the end of a sentence that begins with who it is. */
export function deed(intervention: Intervention): string {
  const { act, object, place, manner } = intervention;
  const name = plain(object ?? "");
  if (act === "release" && object !== null && place === null) {
    return `puts ${name} aside`;
  }
  return act === "steal" && manner === "pull" ? `pulls ${name} out of the gripper` : about(DEEDS[act], name);
}

const NAMELESS: readonly string[] = ["token", "anybody"];

/** Who did something, after what they did; nothing where they have no name, or in an old journal. */
function by(author: Author | null | undefined): string {
  const name = author?.principal ?? "token";
  return NAMELESS.includes(name) ? "" : ` by ${name}`;
}

/** The lines of an event; none for those that others already tell. */
export function linesOf(event: Event): Line[] {
  const line = (tone: Tone, text: string, speaker = ""): Line[] => [
    { seq: event.seq, time: event.time, speaker, text, tone },
  ];
  switch (event.type) {
    case "run_started":
      return line("run", `The run of ${plain(event.tree_name)} in ${plain(event.world)} begins.`);
    case "run_paused":
      return line("run", `The run is paused${by(event.author)}.`);
    case "run_resumed":
      return line("run", `The run goes on${by(event.author)}.`);
    case "run_finished":
      return [
        ...event.missing.flatMap((part) =>
          line("setback", `${plain(part.object)} is not at ${plain(part.place)}${asSaid(part.left_out_by)}.`),
        ),
        ...line("finished", `The run has finished: ${finishedWords(event)}.`),
      ];
    case "run_failed":
      return line("failed", `The run has failed: ${event.reason}`);
    case "run_aborted":
      return line("failed", `The run was aborted: ${event.reason || by(event.author).trim() || "by a person"}.`);
    case "node_started":
      return line("choice", `starts ${plain(event.name)}${attempt(event)}${comparison(event)}.`, event.robot);
    case "node_taken":
      return line("choice", `has taken ${plain(event.name)}, to do it.`, event.helper);
    case "step_started":
      return [
        {
          seq: event.seq,
          time: event.time,
          speaker: plain(event.name),
          text: `${event.step} ${plain(event.step_name)}`,
          tone: "step",
          thread: event.execution,
        },
      ];
    case "node_done":
      return line("done", `${plain(event.name)} is done${DOERS[event.by]}.`);
    case "node_reset": {
      const failed = event.failed_attempt ? ", a failed attempt" : "";
      return line("setback", `${plain(event.name)} is put back${failed}: ${event.reason}.`);
    }
    case "node_undone":
      return line("setback", `${plain(event.name)} is done no longer: ${event.reason}.`);
    case "node_left_out":
      return line("setback", `${plain(event.name)} is left out, as ${event.helper} said.`);
    case "node_returned":
      return line("done", `sees ${plain(event.name)}, which was left out, at its place.`, event.robot);
    case "node_abandoned":
      return line("setback", `The alternative ${plain(event.name)} is abandoned: ${event.reason}.`);
    case "suspected_false_alarm": {
      const told = event.told.length > 0 ? `; a mail goes to ${event.told.join(", ")}` : "";
      const what = `${plain(event.issue)} ${plain(event.object ?? event.name)}`;
      return line(
        "setback",
        `The robot may be wrong: ${what} ${event.times} times on end, and nothing was seen to change${told}.`,
      );
    }
    case "issue_raised": {
      const where = event.step > 0 ? `in step ${event.step}` : "while it looks and plans";
      return line("fault", `notices: ${plain(event.issue)}, ${plain(event.object ?? event.name)}, ${where}.`, event.robot);
    }
    case "prompt": {
      const again = event.version > 1 ? " (asked again)" : "";
      const to = event.to === null ? "" : ` (to ${event.to})`;
      return line(event.kind === "ask" ? "asked" : "said", `${event.text}${again}${to}`, event.robot);
    }
    case "claimed":
      return line("watched", "is on it.", event.helper);
    case "released":
      return line(
        "watched",
        event.expired ? "has been silent too long, anybody may answer." : "lets it go.",
        event.helper,
      );
    case "answered":
      return line("answered", event.answer === "yes" ? "Yes." : "No.", event.helper);
    case "escalated":
      return line(
        "setback",
        `Nobody answered: ${event.channel === "mail" ? "a mail goes to" : "the question goes to"} ${event.to}.`,
      );
    case "help_awaited":
      return line("watched", `looks for ${promised(event)} until ${event.until.toFixed(1)} s.`, event.robot);
    case "help_verified":
      return line("watched", `sees ${promised(event)}${CHANGES[event.change]}.`, event.robot);
    case "help_not_seen":
      return line("setback", `does not see ${promised(event)}.`, event.robot);
    case "resolved":
      return line("resolved", `Resolved: ${about(RESOLUTIONS[event.resolution], plain(event.name))}.`);
    case "dialogue_closed": {
      const text = CLOSINGS[event.reason];
      return text === undefined ? [] : line("setback", `${capital(text)}.`);
    }
    case "intervention":
      return line(
        "deed",
        `${deed(event.intervention)}${event.ok ? "" : `: in vain, ${event.detail}`}.`,
        `person (${event.by})`,
      );
    case "robot_lost":
      return line("setback", `is lost: ${event.reason}.`, event.robot);
    case "robot_back":
      return line("run", `is back and ${event.continues ? "goes on where it was" : "begins anew"}.`, event.robot);
    case "robot_holding":
      return line("watched", `stops and holds ${held(event.at)}.`, event.robot);
    case "robot_resumed":
      return line("watched", `moves again, at step ${event.step}.`, event.robot);
    default:
      return [];
  }
}

/** What a finished run came to: what was left out, and what nobody can see now. */
export function finishedWords({ missing, unseen = [] }: Pick<RunFinished, "missing" | "unseen">): string {
  const hidden = enumerated(unseen.map(({ object }) => plain(object)));
  return without(missing) + (hidden === "" ? "" : `; the last look did not show ${hidden} there`);
}

function without(missing: readonly MissingPart[]): string {
  const said = new Map<string | null, string[]>();
  for (const { object, left_out_by: by } of missing) said.set(by, [...(said.get(by) ?? []), object]);
  const parts = [...said].map(([by, objects]) => `without ${enumerated(objects)}${asSaid(by)}`);
  return parts.length === 0 ? "the task is done" : `the task is done ${enumerated(parts)}`;
}

function enumerated(words: readonly string[]): string {
  return [words.slice(0, -1).join(", "), ...words.slice(-1)].filter((each) => each !== "").join(" and ");
}

/** Put a line behind those that there are, joined to the last one if both are of one thread. */
export function joined(lines: Line[], line: Line): void {
  const last = lines.at(-1);
  if (last === undefined || line.thread === undefined || last.thread !== line.thread) lines.push(line);
  else lines[lines.length - 1] = { ...last, text: `${last.text} · ${line.text}` };
}

function attempt(event: NodeStarted): string {
  return event.attempt > 1 ? `, attempt ${event.attempt}` : "";
}

function comparison(event: NodeStarted): string {
  const others = event.candidates.length - 1;
  if (others < 1) return "";
  return `, chosen among ${event.candidates.length}`;
}

function asSaid(by: string | null): string {
  return by === null ? "" : `, as ${by} said`;
}

function promised(event: { help: Help; object: string | null; name: string }): string {
  return about(PROMISES[event.help], plain(event.object ?? event.name));
}

function held(at: string): string {
  if (at === "in_place") return "where it is";
  return at === "hand_over" ? "where a person can reach it" : `at ${plain(at)}`;
}

function about(text: string, object: string): string {
  return text.replace("{object}", object);
}

function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
