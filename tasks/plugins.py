"""Finding what packages add through entry points (`mend.behaviors`, `mend.monitors`, ...)."""

from functools import cache
from importlib.metadata import entry_points
from types import MappingProxyType
from typing import Any

from mend.errors import UnavailableError

_OF_EXTRAS = {
    "cv2": "OpenCV",
    "numba": "Numba",
    "ortools": "OR-Tools",
    "rosbags": "rosbags",
    "scipy": "SciPy",
}
"""What only extras of Mend's own distribution bring: as it is imported, and as it is called."""
_DISTRIBUTION = "mend-robots"


def called_of(error: ModuleNotFoundError) -> str | None:
    """What the missing module of an extra is called; None for any other module."""
    return _OF_EXTRAS.get((error.name or "").partition(".")[0])


class PluginError(UnavailableError):
    """A package's entry point cannot be used; the message says which and why."""


@cache
def load_plugins(group: str) -> MappingProxyType[str, Any]:
    """Load every entry point of a group, by name.

    What only an extra of Mend's own could load is left out where that is not installed.
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
            ours = entry.dist is not None and entry.dist.name == _DISTRIBUTION
            if ours and isinstance(error, ModuleNotFoundError) and called_of(error) is not None:
                continue
            raise PluginError(
                f"'{entry.name}' in '{group}' ({entry.value}) cannot be loaded: {error}"
            ) from error
    return MappingProxyType(found)
