"""Simulated people: those who follow every event, those who answer, and those who start runs."""

import asyncio
import json
from collections.abc import Callable
from contextlib import suppress
from typing import Any
from urllib.parse import quote
from uuid import uuid4

import httpx
import numpy as np
from chaos_witness import AnswerAttempt, Outcome, RunAttempt, Witness
from websockets.asyncio.client import connect
from websockets.exceptions import WebSocketException

TRIES_AGAIN_S = 0.2
REQUEST_S = 10.0
MOST_TRIES = 300
LATER = (409, 429, *range(500, 600))
"""Statuses that say that it is to be tried again."""
ENDED = ("finished", "failed", "aborted")
ENDS = tuple(f"run_{each}" for each in ENDED)


class Follower:
    """Hears every event over all lives of the service, and answers some questions at once."""

    def __init__(
        self, name: str, url: str, token: str, witness: Witness, seed: int, eager: float
    ) -> None:
        self.name = name
        self._url = url.replace("http", "ws", 1) + "/ws/helper"
        self._headers = {"Authorization": f"Bearer {token}"}
        self._witness = witness
        self._heard = witness.heard.setdefault(name, [])
        self._rng = np.random.default_rng(seed)
        self._eager = eager
        self._asked: dict[str, AnswerAttempt] = {}
        self.snapshots = 0

    @property
    def seen(self) -> int:
        return int(self._heard[-1]["seq"]) if self._heard else 0

    @property
    def ends(self) -> int:
        """How many runs have ended, by what was heard."""
        return sum(event["type"] in ENDS for event in self._heard)

    @property
    def runs_going_on(self) -> int:
        """How many runs have begun and not ended, by what was heard."""
        return sum(event["type"] == "run_started" for event in self._heard) - self.ends

    async def follow(self) -> None:
        """Until cancelled."""
        while True:
            # A name for each connection, as an answer's author is told by it.
            helper = f"{self.name}-{uuid4().hex[:8]}"
            address = f"{self._url}?helper={quote(helper)}&after={self.seen}"
            with suppress(OSError, WebSocketException, TimeoutError):
                async with connect(address, additional_headers=self._headers) as socket:
                    await self._listen(socket, helper)
            self._forget_what_was_asked()
            await asyncio.sleep(TRIES_AGAIN_S)

    async def _listen(self, socket: Any, helper: str) -> None:
        async for text in socket:
            message = json.loads(text)
            kind = message["type"]
            if kind == "snapshot":
                self.snapshots += 1
            elif kind in ("result", "error"):
                self._settle(message, "accepted" if kind == "result" else "refused")
            elif "seq" in message:
                self._heard.append(message)
                if kind == "prompt" and message["kind"] == "ask":
                    await self._answer(socket, helper, message)

    async def _answer(self, socket: Any, helper: str, prompt: dict[str, Any]) -> None:
        if self._rng.random() >= self._eager:
            return
        key, answer = uuid4().hex, "yes" if self._rng.random() < 0.9 else "no"
        self._asked[key] = AnswerAttempt(helper, prompt["prompt"], answer, "unknown")
        told = {"dialogue": prompt["dialogue"], "prompt": prompt["prompt"], "answer": answer}
        await socket.send(json.dumps({"type": "answer", "id": key, **told}))

    def _settle(self, message: dict[str, Any], outcome: Outcome) -> None:
        asked = self._asked.pop(message.get("id") or "", None)
        if asked is not None:
            told = AnswerAttempt(asked.helper, asked.prompt, asked.answer, outcome)
            self._witness.answers.append(told)

    def _forget_what_was_asked(self) -> None:
        self._witness.answers += self._asked.values()
        self._asked.clear()


class Clients:
    """Those who use REST: they start runs, and answer what is still open."""

    def __init__(self, url: str, token: str, witness: Witness) -> None:
        headers = {"Authorization": f"Bearer {token}"}
        self._http = httpx.AsyncClient(base_url=url, headers=headers, timeout=REQUEST_S)
        self._witness = witness

    async def close(self) -> None:
        await self._http.aclose()

    async def answer_what_is_open(self) -> None:
        """Say yes to whatever is asked, until cancelled."""
        while True:
            for dialogue in await self._listed("/api/dialogues?status=open"):
                if dialogue["awaiting"] == "answer" and dialogue["prompt"] is not None:
                    await self._answer(dialogue["dialogue"], dialogue["prompt"]["prompt"])
            await asyncio.sleep(TRIES_AGAIN_S)

    async def _answer(self, dialogue: str, prompt: str) -> None:
        helper = f"rest-{uuid4().hex[:8]}"
        body = {"prompt": prompt, "answer": "yes", "helper": helper}
        outcome, _ = await self._post(f"/api/dialogues/{dialogue}/answers", body)
        self._witness.answers.append(AnswerAttempt(helper, prompt, "yes", outcome))

    async def keep_running(
        self, many: int, request: Callable[[int], dict[str, Any]], enough: asyncio.Event
    ) -> None:
        """Start a run whenever there are fewer than so many, until there are `enough`."""
        while not enough.is_set():
            running = await self.running()
            if running is not None and running < many:
                seed = len(self._witness.runs)
                outcome, told = await self._post("/api/runs", {**request(seed), "seed": seed})
                self._witness.runs.append(
                    RunAttempt(seed, outcome, told.get("id"), told.get("said", ""))
                )
            else:
                await asyncio.sleep(TRIES_AGAIN_S)

    async def running(self) -> int | None:
        """How many runs have not ended; None if the service does not say."""
        with suppress(httpx.HTTPError, ValueError):
            response = await self._http.get("/api/runs?limit=100")
            if response.status_code == 200:
                return sum(each["status"] not in ENDED for each in response.json())
        return None

    async def last_words(self) -> list[str]:
        """Of each run that has not ended its last events."""
        told = []
        for run in await self._listed("/api/runs?limit=100"):
            if run["status"] not in ENDED:
                events = await self._listed(f"/api/runs/{run['id']}/events?limit=1000")
                last = [f"{each['seq']} {each['type']}" for each in events[-5:]]
                told.append(f"{run['id']} ({run['world']}, {run['status']}): {', '.join(last)}")
        return told

    async def abort_one(self, which: int) -> None:
        """Abort one of the runs that go on."""
        runs = await self._listed("/api/runs?limit=100")
        going = [each["id"] for each in runs if each["status"] in ("running", "paused")]
        if going:
            await self._post(f"/api/runs/{going[which % len(going)]}/abort", None)

    async def _listed(self, path: str) -> list[dict[str, Any]]:
        with suppress(httpx.HTTPError, ValueError):
            response = await self._http.get(path)
            if response.status_code == 200:
                found: list[dict[str, Any]] = response.json()
                return found
        return []

    async def _post(self, path: str, body: Any) -> tuple[Outcome, dict[str, Any]]:
        """Ask once, and again under the same key for as long as nobody knows what came of it."""
        key, asked = {"Idempotency-Key": str(uuid4())}, False
        for _ in range(MOST_TRIES):
            try:
                response = await self._http.post(path, json=body, headers=key)
            except httpx.HTTPError as error:
                if isinstance(error, httpx.ConnectError) and not asked:
                    return "refused", {}
                asked = True
            else:
                if response.is_success:
                    self._witness.repeated += asked
                    return "accepted", response.json()
                # What was asked before may be under way or done, and nobody can say so for now.
                if not asked or response.status_code not in LATER:
                    return "refused", {"said": f"{response.status_code} {response.text[:300]}"}
            await asyncio.sleep(TRIES_AGAIN_S)
        return "unknown", {}
