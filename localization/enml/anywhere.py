"""How likely a scan is for a robot that may be anywhere on the map."""

from copy import copy

import numpy as np
from numpy.typing import NDArray

from mend.localization.beam_model import BeamModelParameters, log_densities
from mend.localization.enml.global_search import Region
from mend.localization.enml.problem import Floats, Indices
from mend.localization.enml.visible import Visible
from mend.maps.compiled import compiled

Bins = NDArray[np.int32]
Logs = NDArray[np.float32]

_PLACES = 512
"""Twice as many change the logarithm by 0.3 in the median on the logs that were looked into."""
_BEARINGS = 180
_HEADINGS = 36
_CELL_M = 0.1
_STEPS = np.array([0.7548776662466927, 0.5698402909980532])
"""Of the Kronecker sequence that fills a square most evenly (Roberts 2018)."""


class Anywhere:
    """The mean likelihood of a scan over places and headings that are spread over a map.

    What the map shows from each place is cast once; a scan is then looked up.
    """

    def __init__(self, visible: Visible, region: Region, model: BeamModelParameters) -> None:
        bearings = (np.arange(_BEARINGS) + 0.5) * 2.0 * np.pi / _BEARINGS
        corner = np.array([region.x_min, region.y_min])
        size = np.array([region.x_max, region.y_max]) - corner
        places = corner + size * np.mod(0.5 + np.outer(np.arange(_PLACES), _STEPS), 1.0)
        self._expected = np.array(
            [
                _bins(visible.cast(np.append(each, 0.0), bearings, model.max_range_m), model)
                for each in places
            ]
        )
        self._use(model)

    def by(self, model: BeamModelParameters) -> "Anywhere":
        """The same places, where scans are weighed by another beam model with the same range."""
        other = copy(self)
        other._use(model)
        return other

    def _use(self, model: BeamModelParameters) -> None:
        self.model = model
        middles = _CELL_M * (np.arange(round(model.max_range_m / _CELL_M), dtype=np.float64) + 0.5)
        self._logs: Logs = log_densities(middles[None, :], middles[:, None], model).astype(
            np.float32
        )

    def log_likelihood(self, ranges: Floats, bearings: Floats) -> float:
        """Of a scan with these ranges (metres) along bearings (radians), by the trust in one."""
        model = self.model
        turns = np.mod(bearings, 2.0 * np.pi) / (2.0 * np.pi)
        columns = (turns * _BEARINGS).astype(np.int64) % _BEARINGS
        logs = score_anywhere(self._expected, self._logs, columns, _bins(ranges, model), _HEADINGS)
        logs *= model.trust * model.beams / max(len(ranges), 1)
        most = float(logs.max())
        return most + float(np.log(np.exp(logs - most).mean()))


def _bins(ranges: Floats, model: BeamModelParameters) -> Bins:
    last = round(model.max_range_m / _CELL_M) - 1
    return np.minimum(ranges / _CELL_M, last).astype(np.int32)


def _score_anywhere(
    expected: Bins, logs: Logs, columns: Indices, ranges: Bins, headings: int
) -> Floats:
    """The sum of log densities at each place and heading, places by headings."""
    places, bearings = expected.shape
    scores = np.zeros((places, headings))
    for place in range(places):
        for heading in range(headings):
            turned = heading * bearings // headings
            total = 0.0
            for beam in range(len(columns)):
                column = columns[beam] + turned
                if column >= bearings:
                    column -= bearings
                total += logs[expected[place, column], ranges[beam]]
            scores[place, heading] = total
    return scores


score_anywhere = compiled(_score_anywhere)
