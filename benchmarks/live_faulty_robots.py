"""Live robots that cost next to nothing, many in one process, each held up again and again.

They speak the robot protocol as `examples/robot/robot.py` does, and tell when they felt what.
"""

import asyncio
import json
import time
from contextlib import suppress
from typing import Any

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

OBJECTS = ("green_leg", "pink_bar", "yellow_bar", "blue_leg", "purple_top", "orange_top")
STEPS = 8
HELD_UP_IN = 2
CLEARED_AFTER_S = 5.0
"""So long after it was felt what is in the way is gone."""
_REST = (0.2, 0.0)


class FaultyRobot:
    """Picks and places by timers; in its second step something is in its way, each time.

    `faults` has the moments at which it felt that (seconds since the epoch), by its execution.
    It is gone after `cleared_after_s`, or once somebody clears it.
    """

    def __init__(self, name: str, step_s: float, cleared_after_s: float = CLEARED_AFTER_S) -> None:
        self.name = name
        self.faults: dict[str, float] = {}
        self._step_s = step_s
        self._cleared_after_s = cleared_after_s
        self._clear = asyncio.Event()
        self._boot, self._seq = f"{time.time_ns():x}", 0
        self._poses = {name: {"x": 0.5, "y": 0.15 * n, "z": 0.7} for n, name in enumerate(OBJECTS)}
        self._placed: set[str] = set()
        self._start: dict[str, Any] = {}
        self._step = 1
        self._tasks: set[asyncio.Task[None]] = set()
        self._socket: ClientConnection

    async def work(self, url: str) -> None:
        """Until the service ends the connection, or it is cancelled."""
        with suppress(ConnectionClosed):
            async with connect(f"{url}/ws/robot", compression=None) as self._socket:
                await self._send(**self._hello())
                async for text in self._socket:
                    await self._hear(json.loads(text))
        for each in self._tasks:
            each.cancel()

    def forget_placed(self) -> None:
        """Somebody has put everything back for the next run."""
        self._placed.clear()

    def clear_way(self) -> None:
        """Somebody takes away what it is held up by."""
        self._clear.set()

    def _hello(self) -> dict[str, Any]:
        return {
            "type": "hello",
            "protocol": 1,
            "robot": self.name,
            "boot": self._boot,
            "cameras": [],
            "time": time.monotonic(),
            "behaviors": ["pick_and_place"],
            "reach": {"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 1.2},
            "room": {"resting": [_REST], "hand_over": (0.4, 0.0), "around_m": 0.1},
        }

    async def _send(self, **message: Any) -> None:
        with suppress(ConnectionClosed):
            await self._socket.send(json.dumps(message))

    async def _report(self, **body: Any) -> None:
        self._seq += 1
        now = {"boot": self._boot, "seq": self._seq, "time": time.monotonic()}
        await self._send(type="report", **now, body=body)

    async def _hear(self, message: dict[str, Any]) -> None:
        if message["type"] == "welcome":
            self._do(self._beat(message["heartbeat_s"] / 2))
        elif message["type"] == "command":
            await self._send(type="taken", command=message["id"])
            await self._carry_out(message["id"], message["body"])

    def _do(self, what: Any) -> None:
        task = asyncio.create_task(what)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _beat(self, period_s: float) -> None:
        while True:
            await self._send(type="heartbeat", time=time.monotonic())
            await asyncio.sleep(period_s)

    async def _carry_out(self, command: str, body: dict[str, Any]) -> None:
        match body["type"]:
            case "start":
                self._start, self._step = body, 1
                self._do(self._pick_and_place())
            case "resume":
                execution = body["execution"]
                await self._report(type="resumed", execution=execution, step=self._step)
                self._step += 1
                self._do(self._pick_and_place())
            case "interrupt":
                at = "neutral" if body["retreat"] else "in_place"
                execution = self._start.get("execution")
                await self._report(type="holding", execution=execution, at=at)
            case "look":
                self._do(self._look(command, body))
            case _:
                pass

    async def _pick_and_place(self) -> None:
        execution = self._start["execution"]
        while self._step <= STEPS:
            at = {"step": self._step, "name": f"step {self._step}"}
            await self._report(type="step_started", execution=execution, **at)
            await asyncio.sleep(self._step_s)
            if self._step == HELD_UP_IN and execution not in self.faults:
                self.faults[execution] = time.time()
                self._clear.clear()
                await self._report(
                    type="issue", execution=execution, issue="blocked", step=self._step,
                    interrupts=True, detection={"camera": "forearm"},
                )  # fmt: skip
                await self._report(type="holding", execution=execution, at="in_place")
                return
            self._step += 1
        self._placed.add(self._start["parameters"]["object"])
        await self._report(type="finished", execution=execution)

    async def _look(self, command: str, look: dict[str, Any]) -> None:
        """Until what is expected is seen, for so long at most."""
        if look.get("expect") == "way_clear":
            left_s = max(0.0, min(self._clear_in_s(), look["within_s"]))
            with suppress(TimeoutError):
                await asyncio.wait_for(self._clear.wait(), left_s)
        await self._report(type="looked", command=command, **self._seen(look))

    def _clear_in_s(self) -> float:
        return self.faults[self._start["execution"]] + self._cleared_after_s - time.time()

    def _seen(self, look: dict[str, Any]) -> dict[str, Any]:
        now = {"yaw": 0.0, "time": time.monotonic()}
        finished = [each for each in look.get("finished", []) if each["object"] in self._placed]
        expect = look.get("expect")
        so = None if expect is None else True
        if expect == "at_place":
            so = look["object"] in self._placed
        elif expect == "way_clear":
            so = self._clear.is_set() or self._clear_in_s() <= 0.0
        return {
            "fulfilled": so,
            "objects": {name: {**pose, **now} for name, pose in self._poses.items()},
            "gripper": {"x": _REST[0], "y": _REST[1], "z": 1.0},
            "there": finished,
        }
