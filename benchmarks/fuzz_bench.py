"""A real service for mutated input, and what is kept in it."""

import asyncio
import hashlib
import json
import logging
import tempfile
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from uuid import UUID, uuid4

import httpx
from fuzz_files import Complaints

from mend.server.access.changes import PrincipalsEditor
from mend.server.access.roles import Role
from mend.server.composition import Service, open_service
from mend.server.journal import events as ev
from mend.server.limits import Limits
from mend.server.settings import Settings

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
COUNTED = (ev.SignedIn, ev.SignInFailed, ev.StepStarted, ev.RobotHolding, ev.InterventionDone)
"""Sign-ins are told whatever comes of them. A robot says a moment later that it holds after a
pause, which step it had begun before it heard of that, and that what was to be done to its world
is."""


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
        editor = PrincipalsEditor(folder / "principals.yaml", by="root")
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
