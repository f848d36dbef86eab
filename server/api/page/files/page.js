// The built-in page: what the robots ask, and what is going on. Everything it knows comes from the
// events of /ws/helper; a lost connection is made again after the last event seen.

import { sentence } from "/page/transcript.js";

const $ = (id) => document.getElementById(id);
const MAX_LINES = 500;
const ENDED = ["finished", "failed", "aborted"];
const STATUS_OF = {
  run_paused: "paused",
  run_resumed: "running",
  run_finished: "finished",
  run_failed: "failed",
  run_aborted: "aborted",
};

const runs = new Map(); // id -> RunView or RunSummary
const dialogues = new Map(); // id -> DialogueView, the open ones
const pictures = new Map(); // run and node -> what the robot saw at the last fault there
let shownRun = null;
let socket = null;
let seen = null;
let pause = 500;
let answering = null;
let refreshing = null;

// --- The service -----------------------------------------------------------------------------

async function call(method, path, body) {
  const options = { method, headers: {} };
  if (body !== undefined) {
    options.headers["Content-Type"] = "application/json";
    options.body = JSON.stringify(body);
  }
  const response = await fetch(path, options);
  if (response.status === 401) await showSignIn();
  if (!response.ok) {
    const problem = await response.json().catch(() => ({ detail: response.statusText }));
    throw new Error((problem.errors || [problem.detail]).join("; "));
  }
  return response.status === 204 ? null : response.json();
}

// What is read while the connection is away is read again with the next snapshot.
function inBackground(promise) {
  promise.catch((error) => console.warn(error.message));
}

function connect() {
  const address = new URL("/ws/helper", location.href);
  address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
  address.searchParams.set("helper", helperName());
  if (seen !== null) address.searchParams.set("after", seen);
  const mine = new WebSocket(address);
  socket = mine;
  mine.onopen = () => {
    pause = 500;
    $("connection").textContent = "Connected";
  };
  mine.onmessage = (frame) => receive(JSON.parse(frame.data));
  mine.onclose = async () => {
    if (socket !== mine) return;
    $("connection").textContent = "Connection lost, trying again …";
    answering = null;
    setTimeout(async () => {
      pause = Math.min(pause * 2, 10000);
      const session = await call("GET", "/api/session").catch(() => null);
      if (session && session.required && !session.signed_in) showSignIn();
      else if (socket === mine) connect();
    }, pause);
  };
}

function reconnect() {
  const old = socket;
  socket = null;
  if (old) old.close();
  connect();
}

function receive(message) {
  if (message.type === "snapshot") takeSnapshot(message);
  else if (message.type === "result") answered(null);
  else if (message.type === "error") answered(message);
  else takeEvent(message);
}

// --- State -----------------------------------------------------------------------------------

function takeSnapshot(snapshot) {
  seen = snapshot.seq;
  dialogues.clear();
  for (const dialogue of snapshot.dialogues) dialogues.set(dialogue.dialogue, dialogue);
  for (const run of snapshot.runs) runs.set(run.id, run);
  inBackground(refreshRuns());
  if (shownRun !== null) refreshTree();
  showQuestion();
}

function takeEvent(event) {
  seen = event.seq;
  const run = runs.get(event.run);
  if (run) {
    run.time = event.time;
    if (STATUS_OF[event.type]) run.status = STATUS_OF[event.type];
  }
  if (event.type === "run_started" || STATUS_OF[event.type]) inBackground(refreshRuns());
  if (event.run === shownRun) {
    addLine(event);
    if (event.type.startsWith("node_") || STATUS_OF[event.type]) refreshTree();
  }
  if (event.type === "issue_raised") pictures.set(event.run + event.node, event.picture);
  if (event.dialogue) takeDialogueEvent(event);
}

function takeDialogueEvent(event) {
  const dialogue = dialogues.get(event.dialogue) || {
    dialogue: event.dialogue,
    run: event.run,
    issue: event.issue,
    object: event.object,
    robot: event.robot,
    name: event.name,
    picture: pictures.get(event.run + event.node) || null,
    prompt: null,
  };
  if (event.type === "dialogue_closed") dialogues.delete(event.dialogue);
  else dialogues.set(event.dialogue, dialogue);
  if (event.type === "prompt") dialogue.prompt = event;
  else if (event.type === "answered") dialogue.prompt = null;
  else if (event.type === "claimed") dialogue.claimed_by = event.helper;
  else if (event.type === "released") dialogue.claimed_by = null;
  if (event.type === "answered" && event.helper !== helperName()) {
    $("answer-note").textContent = `${event.helper} answered ${event.answer}.`;
  }
  showQuestion();
}

function openQuestion() {
  for (const dialogue of dialogues.values()) {
    if (dialogue.prompt && dialogue.prompt.kind === "ask") return dialogue;
  }
  return null;
}

// --- The question ----------------------------------------------------------------------------

function showQuestion() {
  const dialogue = openQuestion();
  $("question").classList.toggle("open", dialogue !== null);
  $("answers").hidden = dialogue === null;
  if (dialogue === null) {
    setText("asked-about", "");
    setText("asked-text", "Nothing to answer.");
    setText("claim-note", "");
    $("asked-picture").hidden = true;
    return;
  }
  const { prompt } = dialogue;
  const waiting = dialogues.size - 1;
  const more = waiting > 0 ? ` · ${waiting} more waiting` : "";
  setText("asked-about", `${dialogue.robot} · ${dialogue.issue} · ${dialogue.name}${more}`);
  setText("asked-text", prompt.text);
  for (const { value, effect } of prompt.answers) setText(`${value}-effect`, effect);
  const other = dialogue.claimed_by && dialogue.claimed_by !== helperName();
  setText("claim-note", other ? `${dialogue.claimed_by} is on it.` : "");
  showPicture(dialogue.picture);
  const busy = answering === prompt.prompt;
  $("yes").disabled = busy;
  $("no").disabled = busy;
}

function setText(id, text) {
  // A live region is read out again at every change, so nothing is written twice.
  if ($(id).textContent !== text) $(id).textContent = text;
}

function showPicture(picture) {
  const address = picture ? `/api/pictures/${picture}` : "";
  if ($("asked-picture").getAttribute("src") !== address) $("asked-picture").src = address;
  $("asked-picture").hidden = !picture;
}

function answer(value) {
  const dialogue = openQuestion();
  if (!dialogue || answering || !socket || socket.readyState !== WebSocket.OPEN) return;
  answering = dialogue.prompt.prompt;
  const { prompt } = dialogue.prompt;
  socket.send(
    JSON.stringify({ type: "answer", id: 1, dialogue: dialogue.dialogue, prompt, answer: value }),
  );
  $("answer-note").textContent = `You answered ${value}.`;
  showQuestion();
}

function answered(error) {
  answering = null;
  if (error) {
    $("answer-note").textContent = error.answered_by
      ? `${error.answered_by} was faster.`
      : error.detail;
  }
  showQuestion();
}

// --- Runs, tree, transcript ------------------------------------------------------------------

async function refreshRuns() {
  for (const run of await call("GET", "/api/runs?limit=30")) {
    runs.set(run.id, { ...runs.get(run.id), ...run });
  }
  const newest = [...runs.values()].sort((a, b) => b.started.localeCompare(a.started));
  $("runs").replaceChildren(...newest.slice(0, 30).map(runLine));
  if (shownRun === null && newest.length > 0) await showRun(newest[0].id);
  else showRunButtons();
}

function runLine(run) {
  const line = document.createElement("li");
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = `${run.tree} · ${run.world} · ${run.status}`;
  button.title = run.id;
  button.setAttribute("aria-pressed", String(run.id === shownRun));
  button.onclick = () => inBackground(showRun(run.id));
  line.append(button);
  return line;
}

async function showRun(run) {
  shownRun = run;
  for (const button of $("runs").querySelectorAll("button")) {
    button.setAttribute("aria-pressed", String(button.title === run));
  }
  $("transcript").replaceChildren();
  const until = seen;
  let after = 0;
  for (;;) {
    const events = await call("GET", `/api/runs/${run}/events?after=${after}&limit=1000`);
    if (shownRun !== run) return;
    const past = events.filter((event) => event.seq <= until);
    past.forEach(addLine);
    if (past.length < 1000) break;
    after = past.at(-1).seq;
  }
  refreshTree();
}

function refreshTree() {
  // Events come in bursts; the tree is read once after each.
  if (refreshing !== null) return;
  refreshing = setTimeout(() => {
    refreshing = null;
    inBackground(readTree());
  }, 100);
}

async function readTree() {
  const run = await call("GET", `/api/runs/${shownRun}`);
  runs.set(run.id, run);
  if (run.id === shownRun) showTree(run);
}

function showTree(run) {
  $("nodes").replaceChildren(...run.nodes.slice(0, 1000).map(nodeLine));
  const missing = (run.result?.missing || []).map((part) => part.object);
  const note = missing.length > 0 ? ` Not at its place: ${missing.join(", ")}.` : "";
  setText("run-result", run.result ? `${run.status}: ${run.result.reason}${note}` : "");
  showRunButtons();
}

function nodeLine(node) {
  const line = document.createElement("li");
  const depth = node.node === "/" ? 0 : node.node.split("/").length - 1;
  const state = ["abandoned", "done", "active"].find((each) => node[each]) || "";
  line.className = state;
  const name = node.kind === "behavior" ? node.name : node.kind.toUpperCase();
  const owner = node.active && node.owner ? ` by ${node.owner}` : "";
  const mark = document.createElement("span");
  mark.className = "state";
  mark.textContent = state ? ` ${state}${owner}` : "";
  line.append("\u2003".repeat(depth), name, mark);
  return line;
}

function showRunButtons() {
  const status = runs.get(shownRun)?.status;
  $("run-buttons").hidden = !status || ENDED.includes(status);
  $("pause").disabled = status !== "running";
  $("resume").disabled = status !== "paused";
}

function addLine(event) {
  const text = sentence(event);
  if (text === null) return;
  const list = $("transcript");
  const atEnd = list.scrollTop + list.clientHeight >= list.scrollHeight - 40;
  const line = document.createElement("li");
  const time = document.createElement("time");
  time.textContent = `${event.time.toFixed(1)} s`;
  if (event.type === "prompt") line.className = "asked";
  line.append(time, text);
  list.append(line);
  if (list.children.length > MAX_LINES) list.firstElementChild.remove();
  if (atEnd) list.scrollTop = list.scrollHeight;
}

async function command(name) {
  $("start-error").textContent = "";
  try {
    const run = await call("POST", `/api/runs/${shownRun}/${name}`);
    runs.set(run.id, run);
    showTree(run);
  } catch (error) {
    $("start-error").textContent = error.message;
  }
}

async function startRun(submit) {
  submit.preventDefault();
  $("start-error").textContent = "";
  const speed = $("speed").value;
  try {
    const run = await call("POST", "/api/runs", {
      tree: $("tree").value,
      world: $("world").value,
      scenario: $("scenario").value || null,
      speed: speed === "max" ? speed : Number(speed),
      seed: Number($("seed").value),
    });
    runs.set(run.id, run);
    shownRun = null;
    await refreshRuns();
  } catch (error) {
    $("start-error").textContent = error.message;
  }
}

// --- Coming in -------------------------------------------------------------------------------

function helperName() {
  return $("helper").value.trim() || "helper";
}

async function showSignIn() {
  $("work").hidden = true;
  $("sign-in").hidden = false;
  $("connection").textContent = "Not signed in";
  $("token").focus();
}

async function signIn(submit) {
  submit.preventDefault();
  const body = JSON.stringify({ token: $("token").value });
  const headers = { "Content-Type": "application/json" };
  const response = await fetch("/api/session", { method: "POST", headers, body });
  $("sign-in-error").textContent = response.ok ? "" : "This is not the token.";
  $("token").value = "";
  if (response.ok) await begin();
}

async function begin() {
  const session = await call("GET", "/api/session");
  if (session.required && !session.signed_in) return showSignIn();
  $("sign-in").hidden = true;
  $("work").hidden = false;
  const [trees, scenarios] = await Promise.all([
    call("GET", "/api/trees"),
    call("GET", "/api/scenarios"),
  ]);
  $("tree").replaceChildren(...trees.map((tree) => new Option(tree.name)));
  $("scenario").replaceChildren(
    new Option("none", ""),
    ...scenarios.map((scenario) => new Option(scenario.name)),
  );
  connect();
}

function pressed(key) {
  const typing = ["INPUT", "SELECT", "TEXTAREA"].includes(key.target.tagName);
  if (typing || key.ctrlKey || key.altKey || key.metaKey || key.repeat) return;
  if (key.key.toLowerCase() === "y") answer("yes");
  if (key.key.toLowerCase() === "n") answer("no");
}

$("helper").value = localStorage.getItem("helper") || "helper";
$("helper").onchange = () => {
  localStorage.setItem("helper", helperName());
  reconnect();
};
$("sign-in").onsubmit = signIn;
$("start").onsubmit = startRun;
$("yes").onclick = () => answer("yes");
$("no").onclick = () => answer("no");
for (const name of ["pause", "resume", "abort"]) $(name).onclick = () => command(name);
document.addEventListener("keydown", pressed);
begin().catch((error) => {
  $("connection").textContent = error.message;
});
