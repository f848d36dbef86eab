"""When something was, by its message's header."""

from typing import Any

from mend.localization.bags.bag import Received


def stamp_of(header: Any, received: Received) -> int:
    """Nanoseconds of a header, or of the recording where nobody wrote any."""
    return int(header.stamp.sec) * 1_000_000_000 + int(header.stamp.nanosec) or received.recorded_ns
