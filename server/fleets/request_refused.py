"""A request that no robot can meet as it was asked."""

from typing import TYPE_CHECKING

from mend.errors import ConflictError

if TYPE_CHECKING:
    from mend.fleet.dispatch.booking import Answer


class RequestRefusedError(ConflictError):
    """`why`: without its name; `next_possible_s`: from when until when it could be met just now;
    None at no time."""

    def __init__(self, name: str, answer: "Answer") -> None:
        window = answer.next_possible
        instead = "" if window is None else f"; by {window.latest_s:.0f} s it would be possible"
        super().__init__(f"'{name}' cannot be met: {answer.why}{instead}")
        self.why = answer.why
        self.next_possible_s = None if window is None else [window.earliest_s, window.latest_s]
