"""A pretend robot for Mend: pick_and_place by timers, after docs/robot_protocol.md alone.

    python examples/robot/robot.py --url ws://127.0.0.1:8000/ws/robot --robot demo

Needs Python 3.11 and the `websockets` package; the service's token comes from MEND_TOKEN.
"""

import argparse
import asyncio
import json
import os
import random
import sqlite3
import sys
import time
import uuid
from contextlib import suppress

from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus, WebSocketException

STEPS = ["above pick", "pick", "close gripper", "above pick"]
STEPS += ["above place", "place", "open gripper", "above place"]
OBJECTS = ["green_leg", "pink_bar", "yellow_bar", "blue_leg", "purple_top", "orange_top"]


class Robot:
    def __init__(self, name, outbox, step_s):
        self.name, self.boot, self.step_s = name, uuid.uuid4().hex, step_s
        # Everything that it pretends to see, at made-up positions.
        self.poses = {name: {"x": 0.5, "y": 0.15 * i, "z": 0.7} for i, name in enumerate(OBJECTS)}
        self.placed, self.known_commands = set(), set()
        self.start, self.step, self.work = None, 0, None
        self.seq, self.sent, self.socket, self.sending = 0, 0, None, asyncio.Lock()
        self.outbox = sqlite3.connect(outbox, isolation_level=None)
        columns = "id INTEGER PRIMARY KEY AUTOINCREMENT, boot, seq INTEGER, text"
        self.outbox.execute(f"CREATE TABLE IF NOT EXISTS reports ({columns})")

    async def send(self, text):
        if self.socket is not None:
            with suppress(WebSocketException):
                await self.socket.send(text)

    async def report(self, **body):
        self.seq += 1
        report = {"type": "report", "boot": self.boot, "seq": self.seq, "time": time.monotonic()}
        row = (self.boot, self.seq, json.dumps({**report, "body": body}))
        self.outbox.execute("INSERT INTO reports (boot, seq, text) VALUES (?, ?, ?)", row)
        await self.deliver()

    async def deliver(self):
        """Send what was not sent on this connection; it is kept until it is acknowledged."""
        query = "SELECT id, text FROM reports WHERE id > ? ORDER BY id"
        async with self.sending:
            for number, text in self.outbox.execute(query, (self.sent,)).fetchall():
                self.sent = number
                await self.send(text)

    def forget(self, boot, seq):
        self.outbox.execute("DELETE FROM reports WHERE boot = ? AND seq <= ?", (boot, seq))

    async def pick_and_place(self):
        execution, thing = self.start["execution"], self.start["parameters"]["object"]
        for step in range(max(1, self.step), len(STEPS) + 1):
            self.step, name = step, STEPS[step - 1]
            await self.report(type="step_started", execution=execution, step=step, name=name)
            await asyncio.sleep(self.step_s)
        target = self.start.get("target") or self.poses[thing]
        self.poses[thing] = {"x": target["x"], "y": target["y"], "z": target.get("z") or 0.7}
        self.placed.add(thing)
        self.start, self.step = None, 0
        await self.report(type="finished", execution=execution)

    async def carry_out(self, command, body):
        kind, execution = body["type"], self.start and self.start["execution"]
        moving = self.work is not None and not self.work.done()
        if kind == "start" and body["behavior"] == "pick_and_place" and not moving:
            self.start, self.step = body, 0
            self.work = asyncio.create_task(self.pick_and_place())
        elif kind == "resume" and body["execution"] == execution and not moving:
            await self.report(type="resumed", execution=execution, step=max(1, self.step))
            self.work = asyncio.create_task(self.pick_and_place())
        elif kind == "interrupt":
            if moving:
                self.work.cancel()
            if body["retreat"]:
                self.start, self.step = None, 0
            at = "neutral" if body["retreat"] else "in_place"
            await self.report(type="holding", execution=execution, at=at)
        elif kind == "look":
            now, expect = {"yaw": 0.0, "time": time.monotonic()}, body.get("expect")
            seen = {name: {**pose, **now} for name, pose in self.poses.items()}
            so = expect and (expect != "at_place" or body["object"] in self.placed)
            looked = {"objects": seen, "gripper": {"x": 0.4, "y": 0.0, "z": 1.0}, "fulfilled": so}
            await self.report(type="looked", command=command, **looked)
        elif kind != "slow_down":
            await self.report(type="rejected", command=command, reason=f"cannot '{kind}' now")

    def hello(self):
        hello = {"type": "hello", "protocol": 1, "robot": self.name, "boot": self.boot}
        hello |= {"behaviors": ["pick_and_place"], "cameras": [], "time": time.monotonic()}
        hello["reach"] = {"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 1.2}
        if self.start is not None:
            state = "holding" if self.work.done() else "running"
            hello["executing"] = {"execution": self.start["execution"], "state": state}
            hello["executing"]["step"] = self.step
        return json.dumps(hello)

    async def beat(self, heartbeat_s):
        while True:
            await asyncio.sleep(heartbeat_s / 2)
            await self.send(json.dumps({"type": "heartbeat", "time": time.monotonic()}))

    async def converse(self, socket):
        await socket.send(self.hello())
        welcome = json.loads(await socket.recv())
        if welcome["type"] == "error":
            sys.exit(welcome["detail"])
        self.forget(self.boot, welcome["received"])
        self.socket, self.sent = socket, 0
        beating = asyncio.create_task(self.beat(welcome["heartbeat_s"]))
        try:
            await self.deliver()
            async for text in socket:
                message = json.loads(text)
                if message["type"] == "ack":
                    self.forget(message.get("boot") or self.boot, message["seq"])
                elif message["type"] == "error":
                    sys.stderr.write(f"the service says: {message['detail']}\n")
                elif message["type"] == "command":
                    await self.send(json.dumps({"type": "taken", "command": message["id"]}))
                    if message["id"] not in self.known_commands:
                        self.known_commands.add(message["id"])
                        await self.carry_out(message["id"], message["body"])
        finally:
            self.socket = None
            beating.cancel()

    async def run(self, url, token):
        headers, delay_s = {"Authorization": f"Bearer {token}"} if token else {}, 0.1
        while True:
            try:
                async with connect(url, additional_headers=headers, compression=None) as socket:
                    delay_s = 0.1
                    await self.converse(socket)
            except InvalidStatus as error:
                if error.response.status_code in (401, 403):
                    sys.exit(error.response.body.decode())
            except (OSError, WebSocketException):
                pass  # it is not there, or not any more
            await asyncio.sleep(delay_s * random.uniform(0.5, 1.0))
            delay_s = min(2.0, delay_s * 2)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="A pretend robot for Mend.")
    parser.add_argument("--url", default="ws://127.0.0.1:8000/ws/robot")
    parser.add_argument("--robot", default="demo")
    parser.add_argument("--outbox", default=":memory:", help="an SQLite file that outlives it")
    parser.add_argument("--step-s", type=float, default=0.2, help="how long a step takes")
    told = parser.parse_args()
    with suppress(KeyboardInterrupt):
        asyncio.run(
            Robot(told.robot, told.outbox, told.step_s).run(told.url, os.environ.get("MEND_TOKEN"))
        )
