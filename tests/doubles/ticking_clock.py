"""A clock that a test moves."""


class TickingClock:
    """Tells seconds; every look at it takes `step_s`."""

    def __init__(self, step_s: float = 0.0) -> None:
        self.now_s = 0.0
        self._step_s = step_s

    def __call__(self) -> float:
        self.now_s += self._step_s
        return self.now_s
