"""Mutated messages of a helper for a real service."""

import json
from collections.abc import Callable, Sequence
from typing import Any

from fuzz_bench import Bench
from fuzz_files import Finding, Found
from fuzz_mutations import Mutator
from fuzz_said import framed, said
from websockets.asyncio.client import ClientConnection, connect

Judge = Callable[[str, bytes, Sequence[str]], None]


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
        {"type": "done", **of_it, "id": "b"},
        {"type": "take_back", **of_it},
        {"type": "answer", **asked, "answer": "yes", "id": 1},
        {"type": "ping", "id": 7},
        {"type": "auth", "token": "wrong"},
    ]
    before = await made.state()
    url = made.socket("/ws/helper?helper=anna")

    def judge(name: str, sample: bytes, answers: Sequence[str]) -> None:
        for each in answers:
            told = json.loads(each)
            if told.get("type") == "error":
                found.refused += 1
                if told["status"] >= 500:
                    found.add(Finding(name, f"{told['status']} {told['detail'][:200]}", sample))

    await _converse(made, found, mutator, url, made.headers, messages, judge, mutations, "helper")
    after = await made.state()
    told = await made.since(before[1])
    if after[0] != before[0] or told:
        found.add(Finding("helper", f"it changed: {[vars(e)['type'] for e in told]}", b""))
    return found


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
                    answers = await _answers(socket, framed(mutator, sample), f"after {name}")
                except TimeoutError:
                    found.add(Finding(name, "after it nothing is answered", sample))
                    break
                judge(name, sample, answers)
                for each in made.tracebacks():
                    found.add(Finding(name, f"a traceback: {each[-300:]}", sample))
                if socket.state.name != "OPEN":
                    break


async def _answers(socket: ClientConnection, sample: bytes | str, mark: str) -> list[str]:
    """What is answered to a message: one is dealt with after the other, and so is a ping."""
    ping = json.dumps({"type": "ping", "id": mark})
    return await said(socket, [sample, ping], lambda told: told.get("id") == mark)
