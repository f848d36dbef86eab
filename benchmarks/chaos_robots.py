"""Example robots in processes of their own, which are started again when they die."""

import asyncio
import os
import signal
import sys
from contextlib import suppress
from pathlib import Path

ROBOT = Path(__file__).parents[1] / "examples" / "robot" / "robot.py"
STEP_S = 0.05


class RobotKeeper:
    """Keeps one program of the robot `name` running; what it reports is kept in an outbox.

    Where no credential is needed, an empty one will do.
    """

    def __init__(
        self, name: str, url: str, folder: Path, credential: str, step_s: float = STEP_S
    ) -> None:
        self.name = name
        self.starts = 0
        self._step_s = step_s
        self._url = url.replace("http", "ws", 1) + "/ws/robot"
        self._outbox = folder / f"{name}.outbox"
        self._credential = folder / f"{name}.credential"
        self._credential.touch(mode=0o600)
        self._credential.write_text(credential)
        self._process: asyncio.subprocess.Process | None = None

    async def keep(self) -> None:
        """Until cancelled; the program ends with that."""
        try:
            while True:
                self.starts += 1
                self._process = await asyncio.create_subprocess_exec(
                    sys.executable, str(ROBOT), "--url", self._url, "--robot", self.name,
                    "--credential", str(self._credential), "--outbox", str(self._outbox),
                    "--step-s", str(self._step_s),
                    env=dict(os.environ), stderr=asyncio.subprocess.DEVNULL,
                )  # fmt: skip
                await self._process.wait()
                await asyncio.sleep(0.1)
        finally:
            self.kill()
            if self._process is not None:
                # Else its end is heard of by nobody, and what is unclosed fails a later test.
                await self._process.wait()

    def kill(self) -> None:
        self._signal(signal.SIGKILL)

    async def stop_for(self, seconds: float) -> None:
        """Have it do nothing at all for so long."""
        self._signal(signal.SIGSTOP)
        try:
            await asyncio.sleep(seconds)
        finally:
            self._signal(signal.SIGCONT)

    def _signal(self, number: signal.Signals) -> None:
        if self._process is not None and self._process.returncode is None:
            with suppress(ProcessLookupError):
                self._process.send_signal(number)
