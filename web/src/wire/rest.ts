// The service's REST interface, one function an operation.
import type {
  Answered,
  AskedRobotView,
  BehaviorView,
  ChosenView,
  Detection,
  DeviceView,
  DialogueView,
  DocumentCheck,
  DocumentSummary,
  DocumentView,
  Event,
  FleetView,
  HelpersView,
  Intervention,
  IssueSummary,
  Layout,
  LeafSaid,
  NodeSteeringView,
  Problem as ProblemDocument,
  PushView,
  QuestionBatchView,
  RecordingBegun,
  RecordingRequest,
  RequestView,
  RobotView,
  RunRequest,
  RunStarted,
  RunStatus,
  RunSummary,
  RunView,
  ScenarioSummary,
  SceneSummary,
  SessionView,
  SetAutonomyRequest,
  SiteView,
  SpeechView,
  Statistics,
  SteerNodeRequest,
  SteeringView,
  TrialView,
  UnderstoodView,
  WayReport,
  WorldView,
} from "./types";
import type { Told } from "./told";
import { t } from "../words/words";

/** The service refused: what it said in its problem document (RFC 9457). */
export class Refusal extends Error {
  constructor(
    readonly status: number,
    readonly detail: string,
    readonly errors: readonly string[] = [],
    readonly answeredBy: string | null = null,
    /** From when until when a request could be met instead (the building's clock, seconds). */
    readonly nextPossible: readonly number[] | null = null,
    /** Why a request cannot be met. */
    readonly why: string | null = null,
    /** It may come once more, unchanged: nothing is said of what is asked for. */
    readonly later: boolean = false,
  ) {
    super(errors.length > 0 ? errors.join("\n") : detail);
  }
}

/** The service could not be reached at all. */
export class Unreachable extends Error {
  constructor() {
    super(t("The service cannot be reached."));
  }
}

const JSON_TYPE = "application/json";
const SESSION = "/api/session";

let whenRefused: () => void = () => undefined;

/** Hear when the service no longer knows this browser's session. */
export function onSignedOut(listener: () => void): void {
  whenRefused = listener;
}

export async function call<T>(
  method: string,
  path: string,
  body?: unknown,
  { type = JSON_TYPE, signal, key }: { type?: string; signal?: AbortSignal; key?: string } = {},
): Promise<T> {
  const headers: Record<string, string> = key === undefined ? {} : { "Idempotency-Key": `"${key}"` };
  const init: RequestInit = signal === undefined ? { method, headers } : { method, headers, signal };
  if (body !== undefined) {
    headers["Content-Type"] = type;
    init.body = type === JSON_TYPE ? JSON.stringify(body) : (body as BodyInit);
  }
  const response = await fetch(path, init).catch(() => {
    signal?.throwIfAborted();
    throw new Unreachable();
  });
  if (response.status === 401 && path !== SESSION) whenRefused();
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
  const { status, statusText } = response;
  const later = response.headers.has("Retry-After");
  const problem = (await response.json().catch(() => null)) as ProblemDocument | null;
  if (problem === null) return new Refusal(status, statusText, [], null, null, null, later);
  const { detail, errors, answered_by, next_possible_s, why } = problem;
  return new Refusal(status, detail, errors ?? [], answered_by ?? null, next_possible_s ?? null, why ?? null, later);
}

export const segment = encodeURIComponent;

export const session = () => call<SessionView>("GET", SESSION);
export const signIn = (token: string) => call<void>("POST", SESSION, { token });
export const signOut = () => call<void>("DELETE", SESSION);

export const runs = (limit = 100, offset = 0, statuses: readonly RunStatus[] = [], wanted = "") => {
  const query = new URLSearchParams(wanted);
  query.set("limit", String(limit));
  query.set("offset", String(offset));
  statuses.forEach((status) => query.append("status", status));
  return call<RunSummary[]>("GET", `/api/runs?${query}`);
};
export const issues = (wanted: string, before: number | null, limit: number) => {
  const query = new URLSearchParams(wanted);
  query.set("limit", String(limit));
  if (before !== null) query.set("before", String(before));
  return call<IssueSummary[]>("GET", `/api/issues?${query}`);
};
export const statistics = (query: string) => call<Statistics>("GET", `/api/statistics?${query}`);
export const run = (id: string) => call<RunView>("GET", `/api/runs/${segment(id)}`);
export const startRun = (request: RunRequest) => call<RunSummary>("POST", "/api/runs", request);
export const pauseRun = (id: string) => call<RunSummary>("POST", `/api/runs/${segment(id)}/pause`);
export const resumeRun = (id: string) => call<RunSummary>("POST", `/api/runs/${segment(id)}/resume`);
export const abortRun = (id: string) => call<RunSummary>("POST", `/api/runs/${segment(id)}/abort`);
export const intervene = (id: string, intervention: Intervention) =>
  call<Intervention>("POST", `/api/runs/${segment(id)}/interventions`, intervention);

const leaf = <T>(id: string, what: "take" | "give_back" | "say", body: object) =>
  call<T>("POST", `/api/runs/${segment(id)}/leaves/${what}`, body);
export const takeLeaf = (id: string, node: string, helper: string) => leaf<RunSummary>(id, "take", { node, helper });
export const giveLeafBack = (id: string, node: string, helper: string) =>
  leaf<RunSummary>(id, "give_back", { node, helper });
export const sayOfLeaf = (id: string, words: string, helper: string) => leaf<LeafSaid>(id, "say", { words, helper });

/** What may be said of a node of a run now. */
export const steeringOffers = (id: string, node: string) =>
  call<NodeSteeringView>("GET", `/api/runs/${segment(id)}/steering/offers?node=${segment(node)}`);
export const recordCameras = (id: string, wish: RecordingRequest) =>
  call<RecordingBegun>("POST", `/api/runs/${segment(id)}/recordings`, wish);
export const steer = (id: string, wish: SteerNodeRequest | SetAutonomyRequest) =>
  call<SteeringView>("POST", `/api/runs/${segment(id)}/steering`, wish);

const EVENTS_AT_ONCE = 1000;

/** All events of a run after `after`, in order. */
export async function events(id: string, after = 0): Promise<Told[]> {
  const all: Told[] = [];
  for (;;) {
    const path = `/api/runs/${segment(id)}/events?after=${after}&limit=${EVENTS_AT_ONCE}&told=true`;
    const some = await call<Told[]>("GET", path);
    all.push(...some);
    const last = some.at(-1);
    // A page of long events holds fewer than were asked for.
    if (last === undefined) return all;
    after = last.seq;
  }
}

/** How a run began; null where it has no events. */
export async function beginning(id: string): Promise<RunStarted | null> {
  const [first] = await call<Told[]>("GET", `/api/runs/${segment(id)}/events?limit=1`);
  return first?.type === "run_started" ? first : null;
}

export const dialogue = (id: string) =>
  call<DialogueView>("GET", `/api/dialogues/${segment(id)}`);
/** Who may be asked now, and who of them is here, away or busy. */
export const helpers = () => call<HelpersView>("GET", "/api/helpers");
/** The open questions of all runs, the most urgent first; those that may be answered alike together. */
export const questionBatches = () => call<QuestionBatchView[]>("GET", "/api/questions");
/** Choose a way for several questions at once. */
export const chooseForAll = (way: string, prompts: string[], helper: string) =>
  call<ChosenView[]>("POST", "/api/questions/choices", { way, prompts, helper });
export const answer = (id: string, prompt: string, value: "yes" | "no", helper: string) =>
  call<Answered>("POST", `/api/dialogues/${segment(id)}/answers`, { prompt, answer: value, helper });

/** Answer from a page that is being left: nobody is there any more to hear the result. */
export function answerWhileLeaving(
  id: string,
  prompt: string,
  reply: { answer: "yes" | "no" } | { way: string },
  helper: string,
): void {
  void fetch(`/api/dialogues/${segment(id)}/${"way" in reply ? "choices" : "answers"}`, {
    method: "POST",
    headers: { "Content-Type": JSON_TYPE },
    body: JSON.stringify({ prompt, ...reply, helper }),
    keepalive: true,
  });
}

export const speech = () => call<SpeechView>("GET", "/api/speech");
export const promptSoundPath = (id: string, prompt: string) =>
  `/api/dialogues/${segment(id)}/prompts/${segment(prompt)}/speech`;
export const phraseSoundPath = (name: string) => `/api/speech/phrases/${segment(name)}`;

export const push = (helper: string) => call<PushView>("GET", `/api/push?helper=${segment(helper)}`);
export const pushSubscriptions = () => call<DeviceView[]>("GET", "/api/push/subscriptions");
/** Have the service call a device; `found` is what its browser subscribed. */
export function addPushSubscription(found: PushSubscription, device: string, helper: string): Promise<DeviceView> {
  const { endpoint, keys } = found.toJSON();
  const body = { endpoint, keys: { p256dh: keys?.["p256dh"], auth: keys?.["auth"] }, device, helper };
  return call<DeviceView>("POST", "/api/push/subscriptions", body);
}
const device = (id: string) => `/api/push/subscriptions/${segment(id)}`;
export const endPushSubscription = (id: string) => call<void>("DELETE", device(id));
export const tryPushSubscription = (id: string, nonce: string) => call<TrialView>("POST", `${device(id)}/trial`, { nonce });

export const robots = () => call<RobotView[]>("GET", "/api/robots");
const atSite = (site: string, name = "") =>
  `/api/requests${name === "" ? "" : `/${name.split("/").map(segment).join("/")}`}?site=${segment(site)}`;
export const requests = (site: string) => call<RequestView[]>("GET", atSite(site));
const LONGEST_MS = 10_000;
/** Under its `key` a request is booked once, however often it comes. */
export const makeRequest = (site: string, request: object, key: string) =>
  call<RequestView>("POST", atSite(site), request, { key, signal: AbortSignal.timeout(LONGEST_MS) });
export const cancelRequest = (site: string, name: string) => call<void>("DELETE", atSite(site, name));
const ofFleet = (site: string, what = "") => `/api/sites/${segment(site)}/fleet${what}`;
const ofRobot = (site: string, robot: string, what: string) => ofFleet(site, `/robots/${segment(robot)}/${what}`);
export const takeRobotOut = (site: string, robot: string, reason: string) =>
  call<void>("POST", ofRobot(site, robot, "out_of_service"), { reason });
export const putRobotBack = (site: string, robot: string) => call<void>("POST", ofRobot(site, robot, "back_in_service"));
export const sendRobot = (site: string, robot: string, place: string) =>
  call<void>("POST", ofRobot(site, robot, "go"), { place });
export const tellOfWay = (site: string, way: WayReport) => call<void>("POST", ofFleet(site, "/ways"), way);
/** What became of a site after `after`, in order. */
export async function siteEvents(id: string, after = 0): Promise<Event[]> {
  const all: Event[] = [];
  for (;;) {
    const some = await call<Event[]>("GET", `/api/sites/${segment(id)}/events?after=${after}&limit=${EVENTS_AT_ONCE}`);
    all.push(...some);
    const last = some.at(-1);
    if (last === undefined) return all;
    after = last.seq;
  }
}
/** What somebody asks for in words, at the touch screen of a robot if there is one, at HH:MM. */
export const understandRequest = (site: string, words: string, robot: string | null, clock: string) =>
  call<UnderstoodView>("POST", `/api/requests/understand?site=${segment(site)}`, { words, robot, clock });
export const askedRobot = (site: string, robot: string) =>
  call<AskedRobotView>("GET", ofRobot(site, robot, "asking"));
export const fleet = (site: string) => call<FleetView>("GET", ofFleet(site));
export const sites = () => call<SiteView[]>("GET", "/api/sites");
export const worlds = () => call<WorldView[]>("GET", "/api/worlds");
export const scenarios = () => call<ScenarioSummary[]>("GET", "/api/scenarios");
export const trees = () => call<DocumentSummary[]>("GET", "/api/trees");
export const tree = (name: string) => call<DocumentView>("GET", `/api/trees/${segment(name)}`);
export const scene = (name: string) => call<DocumentView>("GET", `/api/scenes/${segment(name)}`);
export const saveTree = (text: string, name?: string) =>
  call<DocumentView>("POST", "/api/trees", name === undefined ? { text } : { name, text });
/** Check a task file without keeping it. */
export const checkTree = (text: string, signal: AbortSignal) =>
  call<DocumentCheck>("POST", "/api/trees/check", { text }, { signal });
export const scenes = () => call<SceneSummary[]>("GET", "/api/scenes");
export const saveScene = (text: string, name: string) => call<DocumentView>("POST", "/api/scenes", { name, text });
/** Check a scene file without keeping it. */
export const checkScene = (text: string, signal: AbortSignal) =>
  call<DocumentCheck>("POST", "/api/scenes/check", { text }, { signal });
export const behaviors = () => call<BehaviorView[]>("GET", "/api/behaviors");
export const deleteTree = (name: string) => call<void>("DELETE", `/api/trees/${segment(name)}`);

export const exportPath = (run: string, format: "csv" | "mcap") => `/api/runs/${segment(run)}/export?format=${format}`;
export const picturePath = (picture: string) => `/api/pictures/${segment(picture)}`;
export const cameraPath = (run: string, camera: string) =>
  `/api/runs/${segment(run)}/cameras/${segment(camera)}`;

export interface CameraPicture {
  readonly blob: Blob;
  /** Where in it the robot looks for what it looks for; null where it looks for nothing, or cannot say. */
  readonly detection: Detection | null;
}

const DETECTION_HEADER = "Mend-Detection";

/** What a camera of a run's robot sees now; of the first that has such a camera without a name. */
export async function cameraPicture(run: string, camera: string, robot?: string): Promise<CameraPicture> {
  const of = robot === undefined ? "" : `?robot=${segment(robot)}`;
  const answer = await read(`${cameraPath(run, camera)}${of}`);
  const told = answer.headers.get(DETECTION_HEADER);
  return { blob: await answer.blob(), detection: told === null ? null : (JSON.parse(told) as Detection) };
}

export const layout = (run: string) => call<Layout>("GET", `/api/runs/${segment(run)}/layout`);

const SPAN_HEADER = "Mend-Poses-Span";

/** The frames recorded from one time of the run to another, and the first and last times recorded. */
export const poses = (run: string, from: number, to: number) => frames(`/api/runs/${segment(run)}/poses`, from, to);

export const fleetPoses = (site: string, from: number, to: number) => frames(`/api/sites/${segment(site)}/fleet/poses`, from, to);

async function frames(path: string, from: number, to: number) {
  const response = await read(`${path}?from_s=${from}&to_s=${to}`);
  const [first, last] = response.headers.get(SPAN_HEADER)?.split(" ").map(Number) ?? [];
  const recorded: readonly [number, number] | null =
    first === undefined || last === undefined ? null : [first, last];
  return { bytes: await response.arrayBuffer(), recorded };
}
