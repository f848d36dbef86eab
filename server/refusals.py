"""What was refused because a limit was reached, counted for those who run the service."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import get_args

from mend.server.limits import LimitName


class Refusals:
    """How often something was beyond each limit, since the service started."""

    def __init__(self) -> None:
        self._counts: dict[str, int] = dict.fromkeys(get_args(LimitName), 0)

    @property
    def counts(self) -> Mapping[str, int]:
        """By the limit's name; a limit that was never reached has 0."""
        return MappingProxyType(self._counts)

    def note(self, limit: LimitName, times: int = 1) -> None:
        """Something was beyond this limit, and so refused, ended or forgotten."""
        self._counts[limit] += times
