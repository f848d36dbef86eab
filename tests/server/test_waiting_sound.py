"""What waits of a microphone's sound, and what is told of what does not."""

from mend.server.cli.sound_device import GAP, WAITING_FRAMES, WaitingSound

FRAME = bytes(640)


async def test_sound_waits_in_order() -> None:
    waiting = WaitingSound()
    for frame in (b"ab", GAP, b"cd"):
        waiting.keep(frame)
    assert [await waiting.take() for _ in range(3)] == [b"ab", GAP, b"cd"]


async def test_what_is_too_much_is_left_out_and_told_of_where_it_is_missing() -> None:
    waiting = WaitingSound()
    for _ in range(WAITING_FRAMES + 50):
        waiting.keep(FRAME)
    for _ in range(WAITING_FRAMES):
        assert await waiting.take() == FRAME
    waiting.keep(b"later")
    assert [await waiting.take() for _ in range(2)] == [GAP, b"later"]
