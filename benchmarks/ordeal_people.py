"""Those whom robots ask: willing, silent, wrong and rude ones, over the helpers' socket."""

import asyncio
import json
import math
from collections import Counter
from collections.abc import Callable
from random import Random
from typing import Any
from uuid import uuid4

from chaos_people import Follower
from chaos_witness import AnswerAttempt, Witness
from ordeal_lies import ASKED

from mend.maps.building.building import Building
from mend.tasks.scene import Scene

MANNERS = {"willing": 70, "unwilling": 6, "silent": 8, "rude": 16}
LIES = 0.15
NEAR_M = 1.0
THINKS_S = 0.3


class People(Follower):
    """Hears everything over all lives of the service, and answers as somebody drawn would.

    `manners`: how often who did what; `calm`: from now on everybody is willing.
    """

    def __init__(
        self, url: str, witness: Witness, seed: int, is_there: Callable[[str, str], bool]
    ) -> None:
        """`is_there`: whether a robot is where somebody is asked whether it is."""
        super().__init__("people", url, "nobody's", witness, seed, 1.0)
        self._chance = Random(seed)
        self._is_there = is_there
        self.manners: Counter[str] = Counter()
        self.calm = False
        self._answering: set[asyncio.Task[None]] = set()

    async def _answer(self, socket: Any, helper: str, prompt: dict[str, Any]) -> None:
        task = asyncio.create_task(self._react(socket, helper, prompt))
        self._answering.add(task)
        task.add_done_callback(self._answering.discard)

    async def _react(self, socket: Any, helper: str, prompt: dict[str, Any]) -> None:
        manner = "willing"
        if not self.calm:
            (manner,) = self._chance.choices(list(MANNERS), weights=list(MANNERS.values()))
        self.manners[manner] += 1
        if manner == "silent":
            return
        await asyncio.sleep(self._chance.uniform(0.0, THINKS_S))
        try:
            if manner == "rude" and not await self._be_rude(socket, helper, prompt):
                return
            await self._say(socket, helper, prompt, self._said(prompt, manner))
        except Exception:
            return

    def _said(self, prompt: dict[str, Any], manner: str) -> str:
        guess = ASKED.search(prompt["text"])
        if guess is None:
            return "no" if manner == "unwilling" else "yes"
        true = self._is_there(prompt["robot"], guess[1])
        lies = not self.calm and self._chance.random() < LIES
        if lies:
            self.manners["lied about where a robot is"] += 1
        return "yes" if true != lies else "no"

    async def _be_rude(self, socket: Any, helper: str, prompt: dict[str, Any]) -> bool:
        """Something that nobody should; whether they answer after all."""
        told = {"dialogue": prompt["dialogue"], "prompt": prompt["prompt"], "id": uuid4().hex}
        rude: list[Any] = [
            {**told, "type": "answer", "answer": "perhaps"},
            {**told, "type": "answer", "answer": "yes", "prompt": str(uuid4())},
            {**told, "type": "claim", "helper": "somebody else"},
            {**told, "type": "extend"},
            {**told, "type": "answer", "answer": "yes" * 20_000},
            "no JSON at all",
            [None] * 50,
        ]
        for each in self._chance.sample(rude, 2):
            await socket.send(each if isinstance(each, str) else json.dumps(each))
        if self._chance.random() < 0.5:
            # Two at once, and once more: the first counts.
            await self._say(socket, helper, prompt, self._chance.choice(("yes", "no")))
        return self._chance.random() < 0.7

    async def _say(self, socket: Any, helper: str, prompt: dict[str, Any], answer: str) -> None:
        key = uuid4().hex
        self._asked[key] = AnswerAttempt(helper, prompt["prompt"], answer, "unknown")
        told = {"dialogue": prompt["dialogue"], "prompt": prompt["prompt"], "answer": answer}
        await socket.send(json.dumps({"type": "answer", "id": key, **told}))


def is_near(building: Building, scene: Scene, at: list[Any], said: str) -> bool:
    """Whether who stands there is about at the place that is called so."""
    floor, x, y = at
    if floor not in building.floors:
        return False
    away_m = {
        name.replace("-", " "): math.hypot(place.pose.x - x, place.pose.y - y)
        for name, place in scene.places.items()
        if building.floor_at(place.pose.z or 0.0) == floor
    }
    return away_m.get(said.replace("-", " "), math.inf) <= min(away_m.values()) + NEAR_M
