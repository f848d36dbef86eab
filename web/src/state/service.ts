// The one connection to the service: who is signed in, the runs, and every event as it comes.
import { signal } from "@preact/signals";
import { type ConnectionState, HelperSocket } from "../wire/helper_socket";
import * as rest from "../wire/rest";
import type { Told } from "../wire/told";
import type { Event, RunStatus, RunSummary, SnapshotMessage } from "../wire/types";
import { awayAfter, onPresence, presence } from "../calling/presence";
import type { Presence } from "../calling/at_page";
import { may, principal, role } from "./access";
import { helperName, pushOn } from "./preferences";
import { takeDialogueEvent, takeDialogues } from "./questions";

export type Session = "unknown" | "needs_token" | "needs_name" | "in";

export const session = signal<Session>("unknown");
/** Whether there was a session here that the service no longer knows. */
export const sessionEnded = signal(false);
export const tokenRequired = signal(false);
export const connection = signal<ConnectionState>("connecting");
/** When the connection was lost, as `Date.now()`; null while there is one. */
export const lostSince = signal<number | null>(null);
/** Why the service cannot keep what happens, so that no run goes on; null while it can. */
export const trouble = signal<string | null>(null);
export const runs = signal<ReadonlyMap<string, RunSummary>>(new Map());
/** Whether the newest runs were read, as they are now. */
export const runsRead = signal(false);

const STATUS_AFTER: Readonly<Partial<Record<Event["type"], RunStatus>>> = {
  run_paused: "paused",
  run_resumed: "running",
  run_finished: "finished",
  run_failed: "failed",
  run_aborted: "aborted",
};

/** After these a run may wait before other leaves, or before none. */
const MAY_END_WAITS: ReadonlySet<Event["type"]> = new Set([
  "leaf_let_go",
  "leaf_tried_again",
  "breakpoint_removed",
  "autonomy_set",
  "node_started",
  "node_taken",
  "node_left_out",
  "node_undone",
  "node_abandoned",
]);

const listeners = new Set<(event: Told) => void>();
const snapshotListeners = new Set<() => void>();
let socket: HelperSocket | null = null;

/** Hear every event as it comes; returns how to stop. */
export function onEvent(listener: (event: Told) => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Hear of every snapshot: what was folded from events before may lack some. */
export function onSnapshot(listener: () => void): () => void {
  snapshotListeners.add(listener);
  return () => snapshotListeners.delete(listener);
}

/** Find out who this is, and connect when that is known. */
export async function begin(): Promise<void> {
  try {
    const { required, signed_in, name, role: given } = await rest.session();
    tokenRequired.value = required;
    role.value = given;
    principal.value = name;
    if (name !== null) helperName.value = name;
    session.value = required && !signed_in ? "needs_token" : helperName.value === "" ? "needs_name" : "in";
  } catch {
    becomes("lost");
    window.setTimeout(() => void begin(), 1000);
    return;
  }
  if (session.value === "in") connect();
}

export async function signIn(token: string): Promise<void> {
  await rest.signIn(token);
  sessionEnded.value = false;
  await begin();
}

/** Rejects, and stays signed in, where the service cannot end the session now. */
export async function signOut(): Promise<void> {
  // Whoever signs in here next has not asked for the calls of somebody else.
  if (pushOn.value) await import("../calling/push").then((push) => push.callThisDeviceNoMore()).catch(() => undefined);
  socket?.close();
  socket = null;
  try {
    await rest.signOut();
  } finally {
    await begin();
  }
}

/** Be called `name` from now on. */
export async function call(name: string): Promise<void> {
  helperName.value = name;
  await begin();
}

/** Look for the service now rather than after the next pause. */
export function hurry(): void {
  socket?.hurry();
}

/** Send a command over the helper's socket. */
export function command(message: Parameters<HelperSocket["send"]>[0]): ReturnType<HelperSocket["send"]> {
  return socket === null ? Promise.reject(new rest.Unreachable()) : socket.send(message);
}

function connect(): void {
  socket?.close();
  const receiver = {
    snapshot: takeSnapshot,
    event: takeEvent,
    state: becomes,
    trouble: (reason: string | null) => {
      trouble.value = reason;
    },
    mayReconnect,
  };
  socket = new HelperSocket(helperName.value, receiver, () => presence.value);
  socket.connect();
}

function tellPresence(now: Presence): void {
  if (!may("helper")) return;
  command({ type: "here", presence: now }).then(
    ({ away_after_s }) => awayAfter(Number(away_after_s)),
    () => undefined,
  );
}

function becomes(state: ConnectionState): void {
  connection.value = state;
  if (state === "lost") lostSince.value ??= Date.now();
  else if (state !== "connecting") lostSince.value = null;
}

async function mayReconnect(): Promise<boolean> {
  const found = await rest.session().catch(() => null);
  if (found !== null && (!found.required || found.signed_in)) role.value = found.role;
  if (found === null || !found.required || found.signed_in) return true;
  endSession();
  return false;
}

function takeSnapshot(snapshot: SnapshotMessage): void {
  // The address said so when this connection was begun.
  tellPresence(presence.value);
  const next = new Map(runs.value);
  for (const run of snapshot.runs) next.set(run.id, run);
  runs.value = next;
  takeDialogues(snapshot.dialogues, new Map(snapshot.runs.map((run) => [run.id, run.time])));
  void refreshRuns();
  for (const listener of snapshotListeners) listener();
}

function takeEvent(event: Told): void {
  takeDialogueEvent(event, helperName.value);
  const run = runs.value.get(event.run);
  const status = STATUS_AFTER[event.type];
  if (run !== undefined && status !== undefined) {
    runs.value = new Map(runs.value).set(run.id, { ...run, status, time: event.time });
  }
  if (event.type === "leaf_held" || (run !== undefined && run.waits.length > 0 && MAY_END_WAITS.has(event.type))) {
    void refreshRuns();
  }
  if (event.type === "run_started" || event.type === "run_finished" || event.type === "run_failed") {
    void refreshRuns();
  }
  for (const listener of listeners) listener(event);
}

/** Read the list of runs anew. */
export async function refreshRuns(): Promise<void> {
  const read = await rest.runs().catch(() => null);
  runsRead.value = read !== null;
  if (read === null) return;
  const next = new Map(runs.value);
  for (const run of read) next.set(run.id, run);
  runs.value = next;
}

function endSession(): void {
  if (session.value !== "in") return;
  socket?.close();
  socket = null;
  sessionEnded.value = true;
  session.value = "needs_token";
}

onPresence(tellPresence);
rest.onSignedOut(endSession);
window.addEventListener("online", () => socket?.hurry());
window.addEventListener("offline", () => socket?.drop());
