"""Mutated messages of a robot with a valid credential for a real service."""

import json
from dataclasses import dataclass
from typing import Any
from uuid import UUID

import httpx
from fuzz_bench import PATIENCE_S, ROBOT, Bench
from fuzz_files import Finding, Found
from fuzz_mutations import Mutator
from fuzz_said import said
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed


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
        told = json.loads(text)
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
        for answer in await said(socket, mutator, greeting):
            robot.take(answer)
        await _have_a_run(made, client)
        while number < mutations and mutator.random.random() < 0.97:
            name, number = f"robot #{number}", number + 1
            found.tried += 1
            example = mutator.random.choice(robot.examples())
            valid = mutator.random.random() < 0.2
            sample = json.dumps(example).encode() if valid else mutator.of_json(example)
            for answer in await said(socket, mutator, sample):
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
