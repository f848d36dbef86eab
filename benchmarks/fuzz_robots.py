"""Mutated messages of a robot with a valid credential for a real service."""

import json
from dataclasses import dataclass
from typing import Any
from uuid import UUID

import httpx
from fuzz_bench import PATIENCE_S, ROBOT, Bench
from fuzz_files import Finding, Found
from fuzz_mutations import Mutator
from fuzz_said import framed, said
from websockets.asyncio.client import ClientConnection, connect
from websockets.protocol import State


def hello(boot: str) -> dict[str, Any]:
    return {
        "type": "hello", "protocol": 1, "robot": ROBOT, "boot": boot,
        "behaviors": ["pick_and_place"], "cameras": ["head"],
        "reach": {"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 1.0}, "time": 1.0,
        "suitability": {"pick_and_place": 1.0}, "executing": None,
        "shows": {"model": None, "joints": ["a"], "objects": [
            {"name": "cup", "size": [0.1, 0.1, 0.1], "color": [0.1, 0.2, 0.3]}]},
    }  # fmt: skip


NOBODYS, MARK = "nobodys_behavior", "a-boot-of-long-ago"
MISTAKE = json.dumps({**hello("boot"), "suitability": {NOBODYS: None}})
"""Is refused as soon as it is read."""
HELD = {"type": "held", "command": "none"}
KNOWN_REPORT = json.dumps({"type": "report", "boot": MARK, "seq": 1, "time": 2.0, "body": HELD})
"""Is acknowledged after all reports before it, and changes nothing once it was sent."""

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
    welcome: bool = False
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
        told = json.loads(text)
        self.welcome |= told["type"] == "welcome"
        if told["type"] in ("ack", "welcome"):
            self.seq = max(self.seq, told.get("seq", told.get("received", 0)))
        if told["type"] == "command":
            self.command = told["id"]
            self.execution = told["body"].get("execution", self.execution)


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
                start = Start(made, found, mutator, robot, socket)
                number = await start.go_on(client, number, mutations)
    after = await made.state()
    strangers = [each for each in await made.since(before[1]) if each.run not in made.of_robot]
    if after[0] != before[0]:
        found.add(Finding("robot", "documents or principals are not what they were", b""))
    for each in strangers[:5]:
        found.add(Finding("robot", f"it changed another run: {each!r}"[:300], b""))
    return found


@dataclass
class Start:
    """One start of the robot's program: a hello, now and then a mutated one, and what follows."""

    made: Bench
    found: Found
    mutator: Mutator
    robot: Robot
    socket: ClientConnection

    async def go_on(self, client: httpx.AsyncClient, number: int, mutations: int) -> int:
        """Send mutation after mutation, until one ends the connection; returns the next number."""
        greeting = json.dumps(hello(self.robot.boot)).encode()
        if self.mutator.random.random() < 0.5:
            greeting = self.mutator.of_json(hello(self.robot.boot))
            self.found.tried += 1
            number += 1
        goes_on = await self._tell(f"robot #{number}", greeting)
        await _have_a_run(self.made, client)
        while goes_on and number < mutations and self.mutator.random.random() < 0.97:
            self.found.tried += 1
            example = self.mutator.random.choice(self.robot.examples())
            valid = self.mutator.random.random() < 0.2
            sample = json.dumps(example).encode() if valid else self.mutator.of_json(example)
            goes_on = await self._tell(f"robot #{number}", sample)
            number += 1
        return number

    async def _tell(self, name: str, sample: bytes) -> bool:
        """Send a message and see what comes of it; whether the connection is still there."""
        try:
            answers = await self._answers(framed(self.mutator, sample))
        except TimeoutError:
            self.found.add(Finding(name, "after it nothing is answered", sample))
            return False
        refused = [each for each in answers if '"type":"error"' in each]
        ended = self.socket.state is not State.OPEN
        self.found.refused += len(refused) or ended
        for each in self.made.tracebacks():
            self.found.add(Finding(name, f"a traceback: {each[-400:]}", sample))
        return not ended

    async def _answers(self, sample: bytes | str) -> list[str]:
        """What is answered to a message, also late: a report is, once it is on the disk."""
        read = await said(self.socket, [sample, MISTAKE], lambda told: NOBODYS in str(told))
        for each in read:
            self.robot.take(each)
        if not self.robot.welcome:
            return read
        worked_off = await said(self.socket, [KNOWN_REPORT], lambda told: told.get("boot") == MARK)
        for each in worked_off:
            self.robot.take(each)
        return read + worked_off


async def _have_a_run(made: Bench, client: httpx.AsyncClient) -> None:
    """A run of the robot's own, begun anew where the last one has ended."""
    for run in made.of_robot:
        if not (await made.service.runtime.run(run)).status.ended:
            return
    body = {"tree": "eket", "world": "live", "robots": [ROBOT], "answers": "none"}
    answer = await client.post("/api/runs", json=body)
    if answer.is_success:
        made.of_robot.add(UUID(answer.json()["id"]))
