"""A pretend robot for Mend: pick_and_place by timers, after docs/robot_protocol.md alone.

    python examples/robot/robot.py --robot demo

It calls where `mend serve` listens unless told (--url). Needs Python 3.11 and the `websockets`
package. With --credential FILE it shows its own credential, which it fetches the first time with
--code (from `mend access enrol`); else MEND_TOKEN, if set.
"""

import argparse
import asyncio
import json
import logging
import os
import random
import sqlite3
import time
from contextlib import suppress
from pathlib import Path
from urllib.error import HTTPError
from urllib.request import Request, urlopen

from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus, WebSocketException

STEPS = ("above pick", "pick", "close gripper", "above pick")
STEPS += ("above place", "place", "open gripper", "above place")
OBJECTS = ("green_leg", "pink_bar", "yellow_bar", "blue_leg", "purple_top", "orange_top")
REST = (0.2, 0.0)  # where its gripper is while it does nothing
NOTHING_YET = float("inf")  # the service has not said yet which reports it has
TABLE = "reports (id INTEGER PRIMARY KEY AUTOINCREMENT, boot, seq INTEGER, report)"


class Robot:
    def __init__(self, name, outbox, step_s):
        self.name, self.boot, self.step_s = name, f"{time.time_ns():x}", step_s
        # Everything that it pretends to see, at made-up positions.
        self.poses = {name: {"x": 0.5, "y": 0.15 * i, "z": 0.7} for i, name in enumerate(OBJECTS)}
        self.placed, self.known_commands, self.seq, self.sent = set(), set(), 0, 0
        self.start, self.step, self.work, self.socket, self.said = None, 1, None, None, None
        self.outbox = sqlite3.connect(outbox, isolation_level=None)
        self.outbox.execute(f"CREATE TABLE IF NOT EXISTS {TABLE}")

    def say(self, sentence):
        if sentence != self.said:  # what is tried again and again is told once
            logging.info("%s: %s", self.name, sentence)
        self.said = sentence

    async def send(self, **message):
        with suppress(WebSocketException):
            if self.socket is not None:
                await self.socket.send(json.dumps(message))

    async def report(self, **body):
        self.seq += 1
        row = {"boot": self.boot, "seq": self.seq, "time": time.monotonic(), "body": body}
        insert = "INSERT INTO reports (boot, seq, report) VALUES (?, ?, ?)"
        self.outbox.execute(insert, (self.boot, self.seq, json.dumps(row)))
        await self.deliver()

    async def deliver(self):
        unsent = "SELECT id, report FROM reports WHERE id > ? ORDER BY id LIMIT 1"
        while row := self.outbox.execute(unsent, (self.sent,)).fetchone():
            self.sent = row[0]
            await self.send(type="report", **json.loads(row[1]))

    def forget(self, boot, seq):
        self.outbox.execute("DELETE FROM reports WHERE boot = ? AND seq <= ?", (boot, seq))

    async def pick_and_place(self):
        execution, thing = self.start["execution"], self.start["parameters"]["object"]
        for step in range(self.step, len(STEPS) + 1):
            self.step = step
            at = {"step": self.step, "name": STEPS[self.step - 1]}
            await self.report(type="step_started", execution=execution, **at)
            await asyncio.sleep(self.step_s)
        target = self.start.get("target") or self.poses[thing]
        self.poses[thing] = {"x": target["x"], "y": target["y"], "z": target.get("z") or 0.7}
        self.placed.add(thing)
        self.start = None
        await self.report(type="finished", execution=execution)

    async def carry_out(self, command, body):
        kind, execution = body["type"], self.start and self.start["execution"]
        free = self.work is None or self.work.done()
        if kind == "start" and body["behavior"] == "pick_and_place" and free:
            self.start, self.step = body, 1
            self.work = asyncio.create_task(self.pick_and_place())
        elif kind == "resume" and body["execution"] == execution and free:
            await self.report(type="resumed", execution=execution, step=self.step)
            self.work = asyncio.create_task(self.pick_and_place())
        elif kind == "interrupt":
            if self.work is not None:
                self.work.cancel()
            if body["retreat"]:
                self.start = None
            at = "neutral" if body["retreat"] else "in_place"
            await self.report(type="holding", execution=execution, at=at)
        elif kind == "look":
            now, expect = {"yaw": 0.0, "time": time.monotonic()}, body.get("expect")
            seen = {"objects": {name: {**pose, **now} for name, pose in self.poses.items()}}
            seen["gripper"] = {"x": REST[0], "y": REST[1], "z": 1.0}
            finished = body.get("finished", [])
            seen["there"] = [each for each in finished if each["object"] in self.placed]
            so = expect and (expect != "at_place" or body["object"] in self.placed)
            await self.report(type="looked", command=command, fulfilled=so, **seen)
        elif kind != "slow_down":
            await self.report(type="rejected", command=command, reason=f"cannot '{kind}' now")

    async def say_hello(self):
        about = {"robot": self.name, "boot": self.boot, "cameras": [], "time": time.monotonic()}
        about["reach"] = {"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 1.2}
        about["room"] = {"resting": [REST], "hand_over": (0.4, 0.0), "around_m": 0.1}
        if self.start is not None:
            state = "holding" if self.work.done() else "running"
            about["executing"] = {"execution": self.start["execution"], "state": state}
            about["executing"]["step"] = self.step
        await self.send(type="hello", protocol=1, behaviors=["pick_and_place"], **about)

    async def beat(self, socket, period_s):
        while self.socket is socket:
            await self.send(type="heartbeat", time=time.monotonic())
            await asyncio.sleep(period_s)

    async def hear(self, message):
        if message["type"] == "welcome":
            self.say(f"connected to {self.url}")
            self.forget(self.boot, message["received"])
            self.sent = 0
            beat = self.beat(self.socket, message["heartbeat_s"] / 2)
            self.beating = asyncio.create_task(beat)
            await self.deliver()
        elif message["type"] == "ack":
            self.forget(message.get("boot") or self.boot, message["seq"])
        elif message["type"] == "error" and self.sent == NOTHING_YET:
            raise SystemExit(f"{self.name}: {message['detail']}")
        elif message["type"] == "error":
            self.say(f"the service says: {message['detail']}")
        elif message["type"] == "command":
            await self.send(type="taken", command=message["id"])
            if message["id"] not in self.known_commands:
                self.known_commands.add(message["id"])
                await self.carry_out(message["id"], message["body"])

    async def run(self, url, token):
        headers = {"Authorization": f"Bearer {token}"} if token else {}
        self.url = url
        self.say(f"calling {url}")
        while True:
            try:
                async with connect(url, additional_headers=headers, compression=None) as socket:
                    self.socket, self.sent = socket, NOTHING_YET
                    await self.say_hello()
                    async for text in socket:
                        await self.hear(json.loads(text))
                    self.say("the service has ended the connection. Trying again ...")
            except InvalidStatus as refused:
                status = refused.response.status_code
                if status in (401, 403):
                    raise SystemExit(f"{url}: {refused.response.body.decode()}") from None
                self.say(f"{url} answers with HTTP {status}. Trying again ...")
            except WebSocketException as lost:
                self.say(f"the connection to {url} is lost: {lost}. Trying again ...")
            except OSError as error:
                why = f"{error}: is 'mend serve' running? Trying again ..."
                self.say(f"nobody answers at {url}: {why}")
            self.socket = None
            await asyncio.sleep(random.uniform(0.1, 1.0))


def credential(url, name, file, code):
    if code and not file.exists():
        address = "http" + url.removeprefix("ws").replace("/ws/robot", "/api/robots/enrol")
        body = json.dumps({"robot": name, "code": code}).encode()
        try:
            with urlopen(Request(address, body, {"Content-Type": "application/json"})) as answer:
                token = json.load(answer)["token"]
        except HTTPError as refused:
            raise SystemExit(json.load(refused)["detail"]) from None
        file.touch(mode=0o600)
        file.write_text(token)
    return file.read_text().strip()


parser = argparse.ArgumentParser(description="A pretend robot for Mend.")
parser.add_argument("--url", default="ws://127.0.0.1:8080/ws/robot")
parser.add_argument("--robot", default="demo")
parser.add_argument("--outbox", default=":memory:", help="an SQLite file that outlives it")
parser.add_argument("--step-s", type=float, default=0.2, help="how long a step takes")
parser.add_argument(
    "--credential", type=Path, help="the file that keeps the robot's own credential"
)
parser.add_argument("--code", help="a one-time code, to fetch the credential with")
told = parser.parse_args()
logging.basicConfig(level=logging.INFO, format="%(message)s")
logging.getLogger("websockets").setLevel(logging.ERROR)
token = os.environ.get("MEND_TOKEN")
if told.credential:
    token = credential(told.url, told.robot, told.credential, told.code)
robot = Robot(told.robot, told.outbox, told.step_s)
with suppress(KeyboardInterrupt):
    asyncio.run(robot.run(told.url, token))
