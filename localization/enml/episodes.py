"""Where an episode begins: no short-term correspondence crosses its boundary."""

from collections.abc import Iterable


def episode_start(
    count: int, ties: Iterable[tuple[int, int]], min_length: int, max_length: int
) -> int:
    """The index of the first of `count` poses that the newest episode still needs.

    It is the latest boundary with at least `min_length` poses after it that none of the `ties`
    (earlier, later) crosses: given the pose there, what came before says nothing more about what
    comes after. Where every boundary is crossed, only the newest `max_length` poses stay.
    """
    latest = max(count - min_length, 0)
    crossed = bytearray(count + 1)
    for earlier, later in ties:
        # A tie crosses every boundary after its earlier pose up to its later one.
        for boundary in range(earlier + 1, min(later, latest) + 1):
            crossed[boundary] = 1
    oldest = max(count - max_length, 0)
    for boundary in range(latest, oldest, -1):
        if not crossed[boundary]:
            return boundary
    return oldest
