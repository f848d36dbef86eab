// The service's REST interface, one function an operation.
import type {
  Answered,
  DialogueView,
  Event,
  Intervention,
  Layout,
  Problem as ProblemDocument,
  RobotView,
  RunRequest,
  RunSummary,
  RunView,
  Scenario,
  SessionView,
  TreeSummary,
  TreeView,
} from "./types";

/** The service refused: what it said in its problem document (RFC 9457). */
export class Refusal extends Error {
  constructor(
    readonly status: number,
    readonly detail: string,
    readonly errors: readonly string[] = [],
    readonly answeredBy: string | null = null,
  ) {
    super(errors.length > 0 ? errors.join("\n") : detail);
  }
}

/** The service could not be reached at all. */
export class Unreachable extends Error {
  constructor() {
    super("The service cannot be reached.");
  }
}

const JSON_TYPE = "application/json";

async function call<T>(method: string, path: string, body?: unknown, type = JSON_TYPE): Promise<T> {
  const init: RequestInit = { method };
  if (body !== undefined) {
    init.headers = { "Content-Type": type };
    init.body = type === JSON_TYPE ? JSON.stringify(body) : String(body);
  }
  const response = await fetch(path, init).catch(() => {
    throw new Unreachable();
  });
  if (!response.ok) throw await refusal(response);
  return (response.status === 204 ? undefined : await response.json()) as T;
}

async function read(path: string): Promise<Response> {
  const response = await fetch(path, { cache: "no-store" }).catch(() => {
    throw new Unreachable();
  });
  if (!response.ok) throw await refusal(response);
  return response;
}

async function refusal(response: Response): Promise<Refusal> {
  const problem = (await response.json().catch(() => null)) as ProblemDocument | null;
  if (problem === null) return new Refusal(response.status, response.statusText);
  const { detail, errors, answered_by } = problem;
  return new Refusal(response.status, detail, errors ?? [], answered_by ?? null);
}

const segment = encodeURIComponent;

export const session = () => call<SessionView>("GET", "/api/session");
export const signIn = (token: string) => call<void>("POST", "/api/session", { token });
export const signOut = () => call<void>("DELETE", "/api/session");

export const runs = (limit = 100, offset = 0) =>
  call<RunSummary[]>("GET", `/api/runs?limit=${limit}&offset=${offset}`);
export const run = (id: string) => call<RunView>("GET", `/api/runs/${segment(id)}`);
export const startRun = (request: RunRequest) => call<RunView>("POST", "/api/runs", request);
export const pauseRun = (id: string) => call<RunView>("POST", `/api/runs/${segment(id)}/pause`);
export const resumeRun = (id: string) => call<RunView>("POST", `/api/runs/${segment(id)}/resume`);
export const abortRun = (id: string) => call<RunView>("POST", `/api/runs/${segment(id)}/abort`);
export const intervene = (id: string, intervention: Intervention) =>
  call<Intervention>("POST", `/api/runs/${segment(id)}/interventions`, intervention);

const EVENTS_AT_ONCE = 1000;

/** All events of a run after `after`, in order. */
export async function events(id: string, after = 0): Promise<Event[]> {
  const all: Event[] = [];
  for (;;) {
    const path = `/api/runs/${segment(id)}/events?after=${after}&limit=${EVENTS_AT_ONCE}`;
    const some = await call<Event[]>("GET", path);
    all.push(...some);
    const last = some.at(-1);
    if (last === undefined || some.length < EVENTS_AT_ONCE) return all;
    after = last.seq;
  }
}

export const dialogue = (id: string) =>
  call<DialogueView>("GET", `/api/dialogues/${segment(id)}`);
export const answer = (id: string, prompt: string, value: "yes" | "no", helper: string) =>
  call<Answered>("POST", `/api/dialogues/${segment(id)}/answers`, { prompt, answer: value, helper });

export const robots = () => call<RobotView[]>("GET", "/api/robots");
export const scenarios = () => call<Scenario[]>("GET", "/api/scenarios");
export const trees = () => call<TreeSummary[]>("GET", "/api/trees");
export const tree = (name: string) => call<TreeView>("GET", `/api/trees/${segment(name)}`);
export const saveTree = (text: string, name?: string) =>
  call<TreeView>("POST", "/api/trees", name === undefined ? { text } : { name, text });
export const deleteTree = (name: string) => call<void>("DELETE", `/api/trees/${segment(name)}`);

export const picturePath = (picture: string) => `/api/pictures/${segment(picture)}`;
export const cameraPath = (run: string, camera: string) =>
  `/api/runs/${segment(run)}/cameras/${segment(camera)}`;

/** What a camera of the run's robot sees now. */
export const cameraPicture = async (run: string, camera: string) => (await read(cameraPath(run, camera))).blob();

export const layout = (run: string) => call<Layout>("GET", `/api/runs/${segment(run)}/layout`);

const SPAN_HEADER = "Mend-Poses-Span";

/** The frames recorded from one time of the run to another, and the first and last times recorded. */
export async function poses(run: string, from: number, to: number) {
  const response = await read(`/api/runs/${segment(run)}/poses?from_s=${from}&to_s=${to}`);
  const [first, last] = response.headers.get(SPAN_HEADER)?.split(" ").map(Number) ?? [];
  const recorded: readonly [number, number] | null =
    first === undefined || last === undefined ? null : [first, last];
  return { bytes: await response.arrayBuffer(), recorded };
}
