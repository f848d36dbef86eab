"""A clock that goes on by the same step whenever it is read."""


class EvenClock:
    """Starts at 0; `step_s` a reading. What is limited by it does the same work in every run."""

    def __init__(self, step_s: float = 0.1) -> None:
        self._step_s = step_s
        self._readings = 0

    def __call__(self) -> float:
        self._readings += 1
        return self._readings * self._step_s
