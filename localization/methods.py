"""The localizers that there are, by name."""

from collections.abc import Callable
from functools import cache

import numpy as np

from mend.localization.localizer import Localizer
from mend.localization.scan import Scan
from mend.maps.vector_map import VectorMap

MakeLocalizer = Callable[[VectorMap, int], Localizer]


def _enml(vector_map: VectorMap, seed: int) -> Localizer:  # noqa: ARG001 - it draws nothing
    from mend.localization.enml.localizer import EnmlLocalizer

    return EnmlLocalizer(vector_map)


def _cgr(vector_map: VectorMap, seed: int) -> Localizer:
    from mend.localization.cgr.localizer import CgrLocalizer

    return CgrLocalizer(vector_map, seed=seed)


def _mcl(vector_map: VectorMap, seed: int) -> Localizer:
    from mend.localization.mcl.localizer import MclLocalizer

    return MclLocalizer(vector_map, seed=seed)


METHODS: dict[str, MakeLocalizer] = {"enml": _enml, "cgr": _cgr, "mcl": _mcl}

_WARMING_UPDATES = 12


@cache
def warm_up(method: str) -> None:
    """Compile what a method needs, by a few updates in a made-up room, at a known place and lost.

    Takes about half a minute the first time on a machine; what was compiled is kept.
    """
    room = VectorMap.of([[-3, -2, 3, -2], [3, -2, 3, 2], [3, 2, -3, 2], [-3, 2, -3, -2]])
    localizer = METHODS[method](room, 1)
    angles = np.linspace(-np.pi, np.pi, 90, endpoint=False)
    to_wall = np.minimum(
        3.0 / np.maximum(np.abs(np.cos(angles)), 1e-9),
        2.0 / np.maximum(np.abs(np.sin(angles)), 1e-9),
    )
    # A box that is on no map, so that what handles unmapped things is compiled too.
    to_wall[20:35] = 1.0
    anywhere = np.diag([100.0, 100.0, 10.0])
    for covariance in (None, anywhere):
        localizer.reset(np.zeros(3), covariance)
        # So many that a search comes to its end.
        for number in range(_WARMING_UPDATES):
            scan = Scan(to_wall, -np.pi, 2.0 * np.pi / 90, 8.0, float(number))
            motion = np.array([0.001, 0.0, 0.0]) if number < 2 else np.array([0.4, 0.0, 0.3])
            localizer.update(motion, scan)
