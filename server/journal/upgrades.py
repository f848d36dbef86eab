"""Reading events that an older Mend wrote: one explicit upgrade per change of an event's shape."""

import json
from collections.abc import Callable, Sequence
from typing import Any

from mend.errors import MendError

Upgrade = Callable[[dict[str, Any]], dict[str, Any]]
"""Takes an event's JSON object as one version wrote it, returns it as the next version would."""

UPGRADES: tuple[Upgrade, ...] = ()
"""UPGRADES[n - 1] leads from version n to n + 1. Never edited, only appended to."""


class UnknownEventVersionError(MendError):
    """An event was written by a newer Mend."""


def current_version(upgrades: Sequence[Upgrade] = UPGRADES) -> int:
    """The version in which events are written now."""
    return len(upgrades) + 1


def upgrade_text(text: str, version: int, upgrades: Sequence[Upgrade] = UPGRADES) -> str:
    """An event's JSON as the current version would have written it.

    Raises `UnknownEventVersionError` for an event of a newer version.
    """
    current = current_version(upgrades)
    if version == current:
        return text
    if version > current:
        raise UnknownEventVersionError(
            f"an event has version {version}, this Mend knows up to {current}"
        )
    event = json.loads(text)
    for upgrade in upgrades[version - 1 :]:
        event = upgrade(event)
    return json.dumps(event, separators=(",", ":"), ensure_ascii=False)
