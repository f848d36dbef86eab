"""How long a robot stands still once it was answered: from the answer to its next step.

A person steals the part again and again while the robot reaches for it, puts it back once the robot
stands still, and a live helper answers "no" to all that is asked, a second and a half later, so
that no physical help is awaited. In the workcell the fast camera is compared with PyBullet's
renderer in the same run.

    python benchmarks/recovery.py [--world workcell] [--answers 100] [--quick]
"""

# ruff: noqa: T201
import argparse
import asyncio
import json
import tempfile
import time
from pathlib import Path
from uuid import UUID

import numpy as np

from mend.server.composition import Service, open_service
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings
from mend.tasks.intervention import Act, Intervention

PART = "green_leg"
STEAL = Intervention(act=Act.STEAL, object=PART)
PUT_BACK = Intervention(act=Act.PUT_BACK, object=PART)
THINKS_S = 1.5
"""So long after the part is back the helper answers."""


async def measure(world: str, renderer: str | None, answers: int) -> list[float]:
    """Seconds from each last answer received to the robot's next step committed."""
    with tempfile.TemporaryDirectory() as folder:
        async with open_service(Settings(port=0, data_dir=Path(folder))) as service:
            request = RunRequest(
                tree="eket",
                world=world,
                speed=5.0,
                seed=1,
                max_attempts=100,
                world_options={"renderer": renderer} if renderer else {},
            )
            run = (await service.runtime.start_run(request)).id
            waits = await _answer_no(service, run, answers)
            await service.runtime.abort(run)
            await service.runtime.wait_for_end(run)
    return waits


async def _answer_no(service: Service, run: UUID, answers: int) -> list[float]:
    """Steal the part, wait until the robot stands still, put it back, answer no, see it go on."""
    waits: list[float] = []
    answered_at: float | None = None
    asked: tuple[UUID, UUID] | None = None
    still = False
    with service.journal.subscribe(0) as subscription:
        async for record in subscription:
            event = json.loads(record.text)
            match event["type"]:
                case "step_started":
                    still = False
                    if answered_at is not None:
                        waits.append(time.perf_counter() - answered_at)
                        answered_at = None
                    if event["step"] == 2:
                        await service.runtime.intervene(run, STEAL)
                case "robot_holding":
                    await service.runtime.intervene(run, PUT_BACK)
                case "intervention" if event["act"] == PUT_BACK.act:
                    await asyncio.sleep(THINKS_S)
                    still = True
                case "prompt" if event["kind"] == "ask":
                    asked = UUID(event["dialogue"]), UUID(event["prompt"])
                case "run_failed" | "run_finished":
                    raise RuntimeError(f"the run ended early: {event}")
            if len(waits) >= answers:
                break
            if still and asked is not None:
                dialogue, prompt = asked
                asked = None
                answered_at = time.perf_counter()
                await service.runtime.dialogues.answer(dialogue, prompt, "no", "benchmark")
    return waits


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--world", choices=["tabletop", "workcell"], default="workcell")
    parser.add_argument("--answers", type=int, default=100)
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    answers = 5 if arguments.quick else min(arguments.answers, 99)
    renderers = ("fast", "bullet") if arguments.world == "workcell" else (None,)
    print("answer received -> next step of the robot, ms    p50    p95    p99    max")
    p99s_ms = []
    for renderer in renderers:
        waits_ms = np.array(asyncio.run(measure(arguments.world, renderer, answers))) * 1e3
        _row(f"{arguments.world} {renderer or ''}", waits_ms)
        p99s_ms.append(float(np.percentile(waits_ms, 99)))
    if len(p99s_ms) > 1:
        print(
            f"ratio at p99, PyBullet's renderer to the fast camera: {p99s_ms[1] / p99s_ms[0]:.1f}"
        )


def _row(name: str, waits_ms: np.ndarray) -> None:
    figures = [*np.percentile(waits_ms, [50, 95, 99]), waits_ms.max()]
    print(f"{name:<46}" + "".join(f"{each:7.1f}" for each in figures))


if __name__ == "__main__":
    main()
