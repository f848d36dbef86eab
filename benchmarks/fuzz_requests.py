"""Mutated requests for a real service, with a credential and without one."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote
from uuid import UUID

import httpx
from fuzz_bench import PATIENCE_S, ROBOT, SCENARIO, SCENE, TREE, Bench
from fuzz_files import Finding, Found
from fuzz_mutations import Mutator

from mend.server.access.permissions import OPEN, PATTERNS


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
        Request("POST", f"{dialogue}/done", {"helper": "anna"}),
        Request("POST", f"{dialogue}/take_back", {"helper": "anna"}),
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


async def fuzz_requests(
    made: Bench, mutations: int, seed: int, most_s: float | None = None
) -> Found:
    """Send an admin's mutated requests, one after the other.

    None may take more than `most_s` of the processor, if that is given.
    """
    return await _fuzz(made, mutations, seed, made.headers, most_s)


async def fuzz_strangers(
    made: Bench, mutations: int, seed: int, most_s: float | None = None
) -> Found:
    """Send mutated requests of somebody without a credential."""
    return await _fuzz(made, mutations, seed, {}, most_s)


async def _fuzz(
    made: Bench, mutations: int, seed: int, headers: Mapping[str, str], most_s: float | None
) -> Found:
    found, mutator = Found(), Mutator(seed)
    examples = requests(made)
    before = await made.state()
    async with _client(made, headers) as client, _client(made, made.headers) as admin:
        for number in range(mutations):
            sent = _mutated(client, mutator, mutator.random.choice(examples))
            if sent is None:
                continue
            name = f"rest #{number} {sent.method} {sent.url.raw_path[:80]!r}"
            found.tried += 1
            began_s = time.process_time()
            try:
                answer = await client.send(sent)
            except httpx.HTTPError as error:
                found.add(Finding(name, f"no answer: {error!r}", sent.content))
                before = await _tidied(made, admin)
                continue
            took_s = time.process_time() - began_s
            if most_s is not None and took_s > most_s:
                found.add(Finding(name, f"{took_s:.1f} s of the processor", sent.content))
            kept = await _judge(made, found, name, sent, answer, before)
            before = kept or await _tidied(made, admin)
    return found


def _client(made: Bench, headers: Mapping[str, str]) -> httpx.AsyncClient:
    return httpx.AsyncClient(base_url=made.service.url, headers=headers, timeout=PATIENCE_S)


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
) -> tuple[str, int] | None:
    """Note what is wrong with an answer; the state after a refusal, which must change nothing."""
    if answer.status_code >= 500:
        found.add(Finding(name, f"{answer.status_code} {answer.text[:200]}", sent.content))
    for each in made.tracebacks():
        found.add(Finding(name, f"a traceback: {each[-300:]}", sent.content))
    if answer.is_success and "authorization" not in sent.headers and not _is_open(sent):
        found.add(Finding(name, f"{answer.status_code} without a credential", sent.content))
    if answer.is_success or answer.is_redirect:
        return None
    found.refused += 1
    if "problem+json" not in answer.headers.get("content-type", ""):
        found.add(Finding(name, f"{answer.status_code} without a problem document", sent.content))
    after = await made.state()
    told = await made.since(before[1]) if after[1] != before[1] else []
    if after[0] != before[0] or told:
        kinds = [vars(each)["type"] for each in told]
        found.add(Finding(name, f"{answer.status_code}, but it changed: {kinds}", sent.content))
    return after


def _is_open(sent: httpx.Request) -> bool:
    """Whether anybody may do what it asks for; pages are open, and are no operations."""
    return not any(
        each.method == sent.method and each.role is not OPEN
        for pattern, each in PATTERNS
        if pattern.match(sent.url.path)
    )


async def _tidied(made: Bench, client: httpx.AsyncClient) -> tuple[str, int]:
    """The state without what a mutation has begun, so that nothing goes on beside the next one."""
    kept = {made.run, made.paused, made.asking}
    for status in ("running", "paused"):
        for each in (await client.get("/api/runs", params={"status": status})).json():
            if UUID(each["id"]) not in kept:
                await client.post(f"/api/runs/{each['id']}/abort")
                await made.service.runtime.wait_for_end(UUID(each["id"]))
    view = await made.service.runtime.run(made.run)
    if view.status == "running":
        await client.post(f"/api/runs/{made.run}/pause")
    return await made.state()
