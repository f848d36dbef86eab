"""A clock that a test moves."""

import asyncio


class TickingClock:
    """Tells seconds; every look at it takes `step_s`."""

    def __init__(self, step_s: float = 0.0) -> None:
        self.now_s = 0.0
        self.step_s = step_s
        self.looks = 0

    def __call__(self) -> float:
        self.now_s += self.step_s
        self.looks += 1
        return self.now_s

    async def looked_at(self, times: int) -> None:
        """Wait until somebody has looked at it so often from now on."""
        until = self.looks + times
        while self.looks < until:  # noqa: ASYNC110
            await asyncio.sleep(0)
