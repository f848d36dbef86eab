"""Finding what packages add through entry points (`mend.behaviors`, `mend.monitors`, ...)."""

from functools import cache
from importlib.metadata import entry_points
from types import MappingProxyType
from typing import Any

from mend.errors import UnavailableError


class PluginError(UnavailableError):
    """A package's entry point cannot be used; the message says which and why."""


@cache
def load_plugins(group: str) -> MappingProxyType[str, Any]:
    """Load every entry point of a group, by name.

    Raises `PluginError` when one cannot be imported or two packages claim one name.
    """
    found: dict[str, Any] = {}
    for entry in sorted(entry_points(group=group), key=lambda each: each.name):
        if entry.name in found:
            raise PluginError(
                f"two packages provide '{entry.name}' in '{group}'; remove one of them"
            )
        try:
            found[entry.name] = entry.load()
        except (ImportError, AttributeError) as error:
            raise PluginError(
                f"'{entry.name}' in '{group}' ({entry.value}) cannot be loaded: {error}"
            ) from error
    return MappingProxyType(found)
