"""The floors over which made-up robots drive: published maps, and what else is there."""

from collections.abc import Sequence
from pathlib import Path

from mend.maps.vector_map import VectorMap
from mend.maps.vector_map_file import read_vector_map
from synthetic.rough_laser import RoughLaser
from synthetic.settings import SceneSettings

_PEOPLE = 1.0
_REMOVED = 0.02
"""Some walls have gone since the map was drawn."""


def floor_maps(folder: Path, wanted: Sequence[str] | None = None) -> dict[str, VectorMap]:
    """The maps `NAME.vectormap.txt` of a folder by their names, all or the `wanted` ones.

    Ends the command with one sentence where there is none of them.
    """
    files = {path.name.split(".")[0]: path for path in sorted(folder.glob("*.vectormap.txt"))}
    if missing := [each for each in wanted or () if each not in files]:
        raise SystemExit(f"there is no {missing[0]}.vectormap.txt in {folder}")
    if not files:
        raise SystemExit(f"there is no *.vectormap.txt in {folder}")
    return {name: read_vector_map(files[name]) for name in wanted or files}


def in_use(length_m: float, explained: float, *, rough: bool) -> SceneSettings:
    """A drive over a floor on which people walk, and whose map is a little out of date."""
    return SceneSettings(
        length_m=length_m,
        explained=explained,
        removed=_REMOVED,
        people=_PEOPLE,
        rough=RoughLaser() if rough else None,
    )
