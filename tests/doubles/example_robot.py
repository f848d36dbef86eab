"""The example robot as a user runs it, in a process of its own."""

import asyncio
import os
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

ROBOT = Path(__file__).parents[2] / "examples" / "robot" / "robot.py"

TOKEN = "secret"


@asynccontextmanager
async def example_robot(
    url: str, *options: str, name: str = "demo"
) -> AsyncIterator[asyncio.subprocess.Process]:
    """Run it until the end of the block; its steps take next to no time unless told."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, str(ROBOT), "--url", url, "--robot", name, "--step-s", "0.001", *options,
        env={**os.environ, "MEND_TOKEN": TOKEN}, stderr=asyncio.subprocess.PIPE,
    )  # fmt: skip
    try:
        yield process
    finally:
        if process.returncode is None:
            process.kill()
        await process.communicate()
