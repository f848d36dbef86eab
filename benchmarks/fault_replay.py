"""The faults of one scene once more, told reading by reading."""

# ruff: noqa: T201

from collections.abc import Iterator
from pathlib import Path

import cv2
from fault_bench import Bench

from mend.robots.arm.grip import GripReading

_MM = 1e3


def told(of: Iterator[Bench], pictures: Path | None) -> Iterator[Bench]:
    """The first bench alone, which prints what its hand reads, and keeps the pictures."""
    bench = next(of)
    print(f"seed {bench.seed}")
    for name, each in bench.scene.objects.items():
        print(f"  {name}: {each.size} m, knob {each.knob}, colour {each.color}")
    bench.perception.on_reading = lambda reading: _tell(bench, reading, pictures)
    yield bench


def _tell(bench: Bench, reading: GripReading, pictures: Path | None) -> None:
    time_s, task, seen = reading.image.time, bench.robot.task_progress, reading.composition
    colors = "nothing seen"
    if seen is not None:
        colors = f"{seen.pixels} px, {seen.own:.2f} own, {seen.other:.2f} {seen.most_other}"
    print(
        f"  {time_s:.2f} s, step {0 if task is None else task.step}: {reading.name} "
        f"{reading.state} ({reading.probability:.3f}), {reading.opening_m * _MM:.1f} of "
        f"{reading.width_m * _MM:.1f} mm, {'presses' if reading.presses else 'loose'}, "
        f"{bench.world.body.contact_force_n():.0f} N{' pushed' if reading.pushed else ''}, "
        f"{colors}; really {bench.world.held}"
    )
    if pictures is not None:
        cv2.imwrite(str(pictures / f"{bench.seed}_{time_s:08.3f}.png"), reading.image.bgr)
