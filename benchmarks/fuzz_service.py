"""A real service, and mutated requests and messages of helpers and robots for it."""

import asyncio
import contextlib
import hashlib
import json
import logging
import tempfile
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from urllib.parse import quote
from uuid import UUID, uuid4

import httpx
from fuzz_files import Complaints, Finding, Found
from fuzz_mutations import Mutator
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from server.access.changes import PrincipalsEditor
from server.access.roles import Role
from server.composition import Service, open_service
from server.journal import events as ev
from server.limits import Limits
from server.settings import Settings

ROBOT = "arm-1"
PATIENCE_S = 60.0

TREE = """\
name: own
tree: {then: [{behavior: pick_and_place, object: red_box, place: left}]}
"""
SCENE = """\
name: one_box
objects:
  red_box: {color: [1.0, 0.1, 0.1], size: [0.04, 0.06, 0.05], pose: {x: 0.5, y: -0.4}}
places:
  left: {pose: {x: 0.5, y: 0.0}}
"""
SCENARIO = """\
name: thief
tree: eket
interventions:
  - {when: {object: pink_bar, step: 4}, do: {act: steal, object: pink_bar}}
answers: [yes]
"""
COUNTED = (ev.SignedIn, ev.SignInFailed, ev.RobotHolding, ev.InterventionDone)
"""Sign-ins are told whatever comes of them. A robot says a moment later that it holds after a
pause, and that what was to be done to its world is."""


@dataclass
class Bench:
    """A service with credentials, two paused runs, and a third that `asks` for an answer."""

    service: Service
    folder: Path
    token: str
    robot_token: str
    complaints: Complaints
    run: UUID = field(default_factory=uuid4)
    paused: UUID = field(default_factory=uuid4)
    of_robot: set[UUID] = field(default_factory=set)
    asking: UUID = field(default_factory=uuid4)
    dialogue: str = ""
    prompt: str = ""

    @property
    def headers(self) -> dict[str, str]:
        return {"Authorization": f"Bearer {self.token}"}

    def socket(self, path: str) -> str:
        return self.service.url.replace("http", "ws", 1) + path

    async def state(self) -> tuple[str, int]:
        """A digest of all that is kept but events, and the number of the last event."""
        journal = self.service.journal
        kept = {kind: await journal.documents(kind) for kind in ("tree", "scene", "scenario")}
        principals = self.folder / "principals.yaml"
        digest = hashlib.sha256(json.dumps(kept, sort_keys=True).encode())
        digest.update(principals.read_bytes())
        return digest.hexdigest(), journal.head

    async def since(self, seq: int) -> list[ev.Event]:
        """The events after one, but for those of the run that asks, and those that follow later."""
        found: list[ev.Event] = []
        while page := await self.service.journal.read(seq, 1000):
            found += [
                each for each in page if not isinstance(each, COUNTED) and each.run != self.asking
            ]
            seq = page[-1].seq
        return found

    def tracebacks(self) -> list[str]:
        found, self.complaints.tracebacks = self.complaints.tracebacks, []
        return found


@asynccontextmanager
async def bench() -> AsyncIterator[Bench]:
    """Start the service; its log goes to what looks for tracebacks."""
    complaints = Complaints()
    root = logging.getLogger()
    root.addHandler(complaints)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        editor = PrincipalsEditor(folder / "principals.yaml", by="root", keep_changes=False)
        token = editor.add("ada", Role.ADMIN, datetime.now(UTC))
        robot_token = editor.enrol(
            ROBOT, editor.open_enrolment(ROBOT, datetime.now(UTC), 5), datetime.now(UTC)
        )
        settings = Settings(
            port=0, data_dir=folder, speech_voice="none", speech_recognition=False,
            log_level="error", heartbeat_s=60.0, robot_hang_timeout_s=600.0,
            robot_lost_timeout_s=600.0, ask_deadline_s=86_400.0,
            limits=Limits(wrong_tokens=2**31 - 1, running_runs=8, departed_robots=10),
        )  # fmt: skip
        # Before uvicorn sets its loggers up: theirs would not reach the root.
        async with open_service(settings) as service:
            for each in ("uvicorn", "uvicorn.error"):
                logging.getLogger(each).addHandler(complaints)
            made = Bench(service, folder, token, robot_token, complaints)
            await _set_the_stage(made)
            yield made
    root.removeHandler(complaints)


async def _set_the_stage(made: Bench) -> None:
    async with httpx.AsyncClient(
        base_url=made.service.url, headers=made.headers, timeout=PATIENCE_S
    ) as client:
        for path, text in (("scenes", SCENE), ("scenarios", SCENARIO)):
            await client.post(f"/api/{path}", json={"text": text})
        body = {"tree": "eket", "world": "tabletop", "speed": 1.0, "answers": "live"}
        for which in ("run", "paused"):
            answer = await client.post("/api/runs", json=body)
            answer.raise_for_status()
            setattr(made, which, UUID(answer.json()["id"]))
        for each in (made.paused, made.run):
            (await client.post(f"/api/runs/{each}/pause")).raise_for_status()
        answer = await client.post("/api/runs", json={**body, "speed": 20.0})
        made.asking = UUID(answer.json()["id"])
        steal = {"act": "steal", "object": "green_leg"}
        await client.post(f"/api/runs/{made.asking}/interventions", json=steal)
        async with asyncio.timeout(PATIENCE_S):
            while not made.prompt:
                for each in (await client.get("/api/dialogues?status=open")).json():
                    if each["awaiting"] == "answer":
                        made.dialogue, made.prompt = each["dialogue"], each["prompt"]["prompt"]
                await asyncio.sleep(0.05)


# --- Requests -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Request:
    """A valid request, of which the body, the query or the path is mutated."""

    method: str
    path: str
    body: Any = None
    text: str | None = None


def requests(made: Bench) -> Sequence[Request]:
    run, prompt = f"/api/runs/{made.run}", made.prompt
    dialogue = f"/api/dialogues/{made.dialogue}"
    start = {"tree": "eket", "world": "tabletop", "speed": "max", "seed": 7, "answers": ["yes"],
             "scenario": None, "scene": None, "interventions": None, "robots": [],
             "max_attempts": 3, "world_options": {"depth_noise": 1.0},
             "person": {"acts": True}}  # fmt: skip
    uploads = [
        Request("POST", f"/api/{kind}{more}", {"name": "own", "text": text}, text)
        for kind, text in (("trees", TREE), ("scenes", SCENE), ("scenarios", SCENARIO))
        for more in ("", "/check")
    ]
    steal = {"act": "move", "object": "pink_bar", "to": {"x": 0.5, "y": 0.1, "yaw": 0.0}}
    return [
        *uploads,
        *uploads,
        Request("PUT", "/api/trees/own", {"text": TREE}, TREE),
        Request("POST", "/api/runs", start),
        Request("POST", "/api/runs", {"tree": "eket", "world": "live", "robots": ["nobody"]}),
        Request("POST", f"{run}/interventions", steal),
        Request("POST", f"{run}/resume", {}),
        Request("POST", f"{dialogue}/answers", {"prompt": prompt, "answer": "yes", "helper": "a"}),
        Request("POST", f"{dialogue}/claim", {"helper": "anna", "take_over": True}),
        Request("POST", f"{dialogue}/extend", {"prompt": prompt, "helper": "anna"}),
        Request("POST", f"{dialogue}/release", {"helper": "anna"}),
        Request("POST", "/api/session", {"token": "wrong"}),
        Request("POST", "/api/robots/enrol", {"robot": ROBOT, "code": "ABCD-EFGH"}),
        Request("POST", "/api/access/principals/nobody/rotate", {"expires_days": 1.5}),
        Request("POST", "/api/access/enrolments", {"robot": "ada", "minutes": 15}),
        Request("POST", "/api/access/principals", {"name": "ada", "role": "viewer"}),
        Request("GET", f"/api/runs?limit=5&offset=0&status=running&before={made.run}"),
        Request("GET", f"{run}/events?after=0&limit=10"),
        Request("GET", f"{run}/poses?from_s=0&to_s=60&limit=10"),
        Request("GET", "/api/access/deeds?after=0&limit=10&who=ada"),
        Request("GET", "/api/dialogues?status=open&limit=1&offset=0"),
        Request("GET", "/api/trees/own"),
        Request("DELETE", "/api/trees/own"),
    ]


ENCODINGS = ("identity", "gzip", "deflate", "br", "chunked")
TYPES = (
    "application/json", "application/yaml", "text/plain", "application/json; charset=utf-16", "",
    "multipart/form-data; boundary=x", "application/x-www-form-urlencoded", "a" * 300,
)  # fmt: skip


async def fuzz_requests(made: Bench, mutations: int, seed: int) -> Found:
    """Send mutated requests, one after the other."""
    found, mutator = Found(), Mutator(seed)
    examples = requests(made)
    before = await made.state()
    async with httpx.AsyncClient(
        base_url=made.service.url, headers=made.headers, timeout=PATIENCE_S
    ) as client:
        for number in range(mutations):
            sent = _mutated(client, mutator, mutator.random.choice(examples))
            if sent is None:
                continue
            name = f"rest #{number} {sent.method} {sent.url.raw_path[:80]!r}"
            found.tried += 1
            try:
                answer = await client.send(sent)
            except httpx.HTTPError as error:
                found.add(Finding(name, f"no answer: {error!r}", sent.content))
                continue
            before = await _judge(made, found, name, sent, answer, before)
            if answer.is_success:
                await _tidy(made, client)
                before = await made.state()
            elif number % 50 == 0:
                before = await made.state()
    return found


def _mutated(client: httpx.AsyncClient, mutator: Mutator, request: Request) -> httpx.Request | None:
    """A request with its body mutated; without one its query; now and then its path, or headers."""
    draw, path, content, headers = mutator.random, request.path, None, {}
    if request.body is not None:
        headers["Content-Type"] = "application/json"
        content = mutator.of_json(request.body)
    if request.text is not None and draw.random() < 0.5:
        headers["Content-Type"] = "application/yaml"
        content = mutator.of_text(request.text.encode())
    if content is None or draw.random() < 0.1:
        given = mutator.of_text(path.removeprefix("/api/").encode())[:3000]
        path = "/api/" + quote(given.decode("utf-8", "replace"), safe="/?&=%", errors="replace")
    if draw.random() < 0.1:
        headers["Content-Type"] = draw.choice(TYPES)
    if draw.random() < 0.1:
        headers["Content-Encoding"] = draw.choice(ENCODINGS)
    if draw.random() < 0.2:
        key = mutator.of_bytes(b'"8e03978e-40d5-43e8-bc93-6894a57f9324"')
        printable = "".join(chr(each) for each in key if 32 <= each < 127)
        headers["Idempotency-Key"] = printable[:400].strip()
    try:
        return client.build_request(request.method, path, content=content, headers=headers)
    except (httpx.InvalidURL, ValueError):
        return None


async def _judge(
    made: Bench,
    found: Found,
    name: str,
    sent: httpx.Request,
    answer: httpx.Response,
    before: tuple[str, int],
) -> tuple[str, int]:
    if answer.status_code >= 500:
        found.add(Finding(name, f"{answer.status_code} {answer.text[:200]}", sent.content))
    for each in made.tracebacks():
        found.add(Finding(name, f"a traceback: {each[-300:]}", sent.content))
    if answer.is_success or answer.is_redirect:
        return before
    found.refused += 1
    if "problem+json" not in answer.headers.get("content-type", ""):
        found.add(Finding(name, f"{answer.status_code} without a problem document", sent.content))
    after = await made.state()
    told = await made.since(before[1]) if after[1] != before[1] else []
    if after[0] != before[0] or told:
        kinds = [vars(each)["type"] for each in told]
        found.add(Finding(name, f"{answer.status_code}, but it changed: {kinds}", sent.content))
    return after


async def _tidy(made: Bench, client: httpx.AsyncClient) -> None:
    """End what a mutation has begun, so that nothing goes on beside the next one."""
    kept = {made.run, made.paused, made.asking}
    for status in ("running", "paused"):
        for each in (await client.get("/api/runs", params={"status": status})).json():
            if UUID(each["id"]) not in kept:
                await client.post(f"/api/runs/{each['id']}/abort")
                await made.service.runtime.wait_for_end(UUID(each["id"]))
    view = await made.service.runtime.run(made.run)
    if view.status == "running":
        await client.post(f"/api/runs/{made.run}/pause")


# --- Helpers --------------------------------------------------------------------------------------


async def fuzz_helper(made: Bench, mutations: int, seed: int) -> Found:
    """Send a helper's mutated messages; a connection that is closed is made again."""
    found, mutator = Found(), Mutator(seed)
    asked = {"dialogue": made.dialogue, "prompt": made.prompt}
    of_it = {"dialogue": made.dialogue}
    messages = [
        {"type": "claim", **of_it, "take_over": True, "id": "a"},
        {"type": "claim", **of_it},
        {"type": "release", **of_it},
        {"type": "extend", **asked},
        {"type": "answer", **asked, "answer": "yes", "id": 1},
        {"type": "ping", "id": 7},
        {"type": "auth", "token": "wrong"},
    ]
    before = await made.state()
    url = made.socket("/ws/helper?helper=anna")

    def judge(name: str, sample: bytes, answers: Sequence[str]) -> None:
        for each in answers:
            said = json.loads(each)
            if said.get("type") == "error":
                found.refused += 1
                if said["status"] >= 500:
                    found.add(Finding(name, f"{said['status']} {said['detail'][:200]}", sample))

    await _converse(made, found, mutator, url, made.headers, messages, judge, mutations, "helper")
    after = await made.state()
    told = await made.since(before[1])
    if after[0] != before[0] or told:
        found.add(Finding("helper", f"it changed: {[vars(e)['type'] for e in told]}", b""))
    return found


Judge = Callable[[str, bytes, Sequence[str]], None]


async def _converse(
    made: Bench, found: Found, mutator: Mutator, url: str, headers: dict[str, str],
    messages: Sequence[Any], judge: Judge, mutations: int, target: str,
) -> None:  # fmt: skip
    number = 0
    while number < mutations:
        async with connect(url, additional_headers=headers, max_size=None) as socket:
            while number < mutations:
                sample = mutator.of_json(mutator.random.choice(messages))
                name = f"{target} #{number}"
                number += 1
                found.tried += 1
                try:
                    answers = await _said(socket, mutator, sample)
                except ConnectionClosed:
                    answers = []
                judge(name, sample, answers)
                for each in made.tracebacks():
                    found.add(Finding(name, f"a traceback: {each[-300:]}", sample))
                if socket.state.name != "OPEN":
                    break


async def _said(socket: ClientConnection, mutator: Mutator, sample: bytes) -> list[str]:
    """Send a message and a ping after it; what is answered until the pong comes."""
    binary = mutator.random.random() < 0.1
    with contextlib.suppress(UnicodeDecodeError):
        await socket.send(sample if binary else sample.decode())
        await (await socket.ping())
    answers: list[str] = []
    with contextlib.suppress(TimeoutError):
        while True:
            async with asyncio.timeout(0.0005):
                answers.append(str(await socket.recv()))
    return answers


# --- Robots ---------------------------------------------------------------------------------------


def hello(boot: str) -> dict[str, Any]:
    return {
        "type": "hello", "protocol": 1, "robot": ROBOT, "boot": boot,
        "behaviors": ["pick_and_place"], "cameras": ["head"],
        "reach": {"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 1.0}, "time": 1.0,
        "suitability": {"pick_and_place": 1.0}, "executing": None,
        "shows": {"model": None, "joints": ["a"], "objects": [
            {"name": "cup", "size": [0.1, 0.1, 0.1], "color": [0.1, 0.2, 0.3]}]},
    }  # fmt: skip


POSE = [0.1, 0.2, 0.3, 0.0, 0.0, 0.0, 1.0]
PICTURE = "/9j/2Q=="
SEEN = {"x": 0.5, "y": 0.1, "z": 0.7, "yaw": 0.0, "time": 1.0}


def bodies(execution: str, command: str) -> list[dict[str, Any]]:
    """Every report that a robot may send of an execution and of a command."""
    detection = {"camera": "head", "size_px": [320, 240], "center": [1.0, 2.0], "area_px": 7,
                 "probability": 0.9, "explanation": "it slipped"}  # fmt: skip
    of_it = {"execution": execution}
    return [
        {"type": "step_started", **of_it, "step": 1, "name": "approach"},
        {"type": "issue", **of_it, "issue": "dropped", "step": 4, "interrupts": True,
         "detection": detection, "jpeg": PICTURE},
        {"type": "clip", **of_it, "issue": "dropped", "pictures": [
            {"before_s": 1.0, "jpeg": PICTURE}]},
        {"type": "holding", **of_it, "at": "neutral"},
        {"type": "resumed", **of_it, "step": 2},
        {"type": "finished", **of_it, "found_in_place": False},
        {"type": "looked", "command": command, "objects": {"green_leg": SEEN},
         "gripper": {"x": 0.5, "y": 0.0, "z": 0.9}, "fulfilled": True,
         "there": [{"object": "green_leg", "place": "green_leg_place"}], "gone": [],
         "held": None, "blind": None},
        {"type": "held", "command": command},
        {"type": "intervened", "intervention": {"act": "steal", "object": "green_leg"},
         "by": "api", "ok": True, "detail": "", "command": command},
        {"type": "rejected", "command": command, "reason": "no"},
    ]  # fmt: skip


@dataclass
class Robot:
    """What a robot knows of its run, to send messages that are nearly valid."""

    boot: str
    seq: int = 0
    execution: str = "none"
    command: str = "none"

    def examples(self) -> list[dict[str, Any]]:
        reports = [
            {"type": "report", "seq": self.seq + 1, "time": 2.0, "body": body, "world": None}
            for body in bodies(self.execution, self.command)
        ]
        return [
            *reports,
            {"type": "heartbeat", "time": 2.0},
            {"type": "taken", "command": self.command},
            {"type": "picture", "command": self.command, "camera": "head", "jpeg": PICTURE},
            {"type": "poses", "time": 2.0, "joints": [0.1], "base": POSE, "tool": POSE,
             "opening_m": 0.1, "objects": [{"pose": POSE, "held": False}]},
        ]  # fmt: skip

    def take(self, text: str) -> None:
        """Remember what the service says."""
        said = json.loads(text)
        if said["type"] in ("ack", "welcome"):
            self.seq = max(self.seq, said.get("seq", said.get("received", 0)))
        if said["type"] == "command":
            self.command = said["id"]
            self.execution = said["body"].get("execution", self.execution)


async def fuzz_robot(made: Bench, mutations: int, seed: int) -> Found:
    """Send a robot's mutated messages, under its own credential, in a run of its own."""
    found, mutator = Found(), Mutator(seed)
    before = await made.state()
    headers = {"Authorization": f"Bearer {made.robot_token}"}
    async with httpx.AsyncClient(
        base_url=made.service.url, headers=made.headers, timeout=PATIENCE_S
    ) as client:
        number = 0
        while number < mutations:
            robot = Robot(f"boot-{number}")
            async with connect(
                made.socket("/ws/robot"), additional_headers=headers, max_size=None
            ) as socket:
                number = await _one_start(made, found, mutator, robot, socket, client, number,
                                          mutations)  # fmt: skip
    after = await made.state()
    strangers = [each for each in await made.since(before[1]) if each.run not in made.of_robot]
    if after[0] != before[0]:
        found.add(Finding("robot", "documents or principals are not what they were", b""))
    for each in strangers[:5]:
        found.add(Finding("robot", f"it changed another run: {each!r}"[:300], b""))
    return found


async def _one_start(
    made: Bench, found: Found, mutator: Mutator, robot: Robot, socket: ClientConnection,
    client: httpx.AsyncClient, number: int, mutations: int,
) -> int:  # fmt: skip
    """One start of the robot's program: a hello, now and then a mutated one, and what follows."""
    greeting = json.dumps(hello(robot.boot)).encode()
    if mutator.random.random() < 0.5:
        greeting = mutator.of_json(hello(robot.boot))
        found.tried += 1
        number += 1
    name = f"robot #{number}"
    sample = greeting
    try:
        for answer in await _said(socket, mutator, greeting):
            robot.take(answer)
        await _have_a_run(made, client)
        while number < mutations and mutator.random.random() < 0.97:
            name, number = f"robot #{number}", number + 1
            found.tried += 1
            example = mutator.random.choice(robot.examples())
            valid = mutator.random.random() < 0.2
            sample = json.dumps(example).encode() if valid else mutator.of_json(example)
            for answer in await _said(socket, mutator, sample):
                found.refused += '"type":"error"' in answer
                robot.take(answer)
    except ConnectionClosed:
        found.refused += 1
    for each in made.tracebacks():
        found.add(Finding(name, f"a traceback: {each[-400:]}", sample))
    return number


async def _have_a_run(made: Bench, client: httpx.AsyncClient) -> None:
    """A run of the robot's own, begun anew where the last one has ended."""
    for run in made.of_robot:
        if not (await made.service.runtime.run(run)).status.ended:
            return
    body = {"tree": "eket", "world": "live", "robots": [ROBOT], "answers": "none"}
    answer = await client.post("/api/runs", json=body)
    if answer.is_success:
        made.of_robot.add(UUID(answer.json()["id"]))
