"""Who is signed in to help, on however many devices, and who of them is on nothing."""

from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from mend.server.runtime.dialogue_state import DialogueState


class Attendance:
    """Helpers who hear what robots ask at this moment."""

    def __init__(self) -> None:
        self._devices: Counter[str] = Counter()

    @contextmanager
    def attending(self, helper: str) -> Iterator[None]:
        """Somebody is there for as long as this lasts."""
        self._devices[helper] += 1
        try:
            yield
        finally:
            self._devices[helper] -= 1
            if self._devices[helper] <= 0:
                del self._devices[helper]

    def idle(self, open_dialogues: Iterable[DialogueState]) -> list[str]:
        """Who is there and on no dialogue, who came first first."""
        busy = set[str]()
        for dialogue in open_dialogues:
            if dialogue.claim is not None:
                busy.add(dialogue.claim.helper)
            if dialogue.awaiting is not None:
                busy.add(dialogue.awaiting.helper)
        return [each for each in self._devices if each not in busy]
