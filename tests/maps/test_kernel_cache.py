"""A compiled kernel is kept until something that is compiled into it changes."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

CALLED = """
from mend.maps.compiled import compiled
{constant}
@compiled
def called(x: float) -> float:
    return {result}
"""
CALLER = """
from called import FACTOR, called
from mend.maps.compiled import compiled

@compiled
def caller(x: float) -> float:
    return FACTOR * called(x)

print(caller(1.0), sum(caller.stats.cache_hits.values()))
"""


def told(folder: Path) -> tuple[float, int]:
    """What the caller comes to, and how often it was found compiled."""
    path = f"{folder}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"
    command = [sys.executable, str(folder / "caller.py")]
    run = subprocess.run(
        command, env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True, check=True
    )
    value, hits = run.stdout.split()
    return float(value), int(hits)


def write(folder: Path, result: str = "x + 1.0", constant: str = "FACTOR = 10.0") -> None:
    (folder / "called.py").write_text(CALLED.format(result=result, constant=constant))
    (folder / "caller.py").write_text(CALLER)


@pytest.mark.slow
def test_it_is_compiled_once_and_again_where_what_it_calls_or_a_constant_is_other(
    tmp_path: Path,
) -> None:
    write(tmp_path)
    assert told(tmp_path) == (20.0, 0)
    assert told(tmp_path) == (20.0, 1)
    write(tmp_path, result="x + 2.0")
    assert told(tmp_path) == (30.0, 0)
    write(tmp_path, result="x + 2.0", constant="FACTOR = 5.0")
    assert told(tmp_path) == (15.0, 0)
    assert told(tmp_path) == (15.0, 1)
