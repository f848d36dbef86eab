"""An ear's port to its process: what is sent when it is far behind."""

import pytest

from mend.server.speech.ear import GAP, MAX_BACKLOG_BYTES, ProcessEar, RecognizerProcess

SOUND = bytes(640)


class SlowProcess(RecognizerProcess):
    """A process that takes what it is sent when a test lets it."""

    def __init__(self) -> None:
        self.sent: list[int] = []
        self.behind = 0

    @property
    def behind_bytes(self) -> int:
        return self.behind

    def send(self, size: int, pcm: bytes = b"") -> None:
        assert len(pcm) == (0 if size == GAP else size)
        self.sent.append(size)


async def give_back(_process: RecognizerProcess) -> None:
    pytest.fail("nothing is closed")


def test_an_ear_that_is_far_behind_is_told_once_that_sound_is_missing() -> None:
    process = SlowProcess()
    ear = ProcessEar(process, give_back)
    ear.hear(SOUND)
    process.behind = MAX_BACKLOG_BYTES + 1
    for _ in range(3):
        ear.hear(SOUND)
    process.behind = 0
    ear.hear(SOUND)
    assert process.sent == [len(SOUND), GAP, len(SOUND)]


def test_each_gap_is_told() -> None:
    process = SlowProcess()
    ear = ProcessEar(process, give_back)
    for _ in range(2):
        ear.skip()
        ear.skip()
        ear.hear(SOUND)
    assert process.sent == [GAP, len(SOUND), GAP, len(SOUND)]
