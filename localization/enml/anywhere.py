"""How likely a scan is for a robot that may be anywhere on the map."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mend.localization.beam_model import BeamModelParameters, log_densities, spread
from mend.localization.enml.classification import look_at
from mend.localization.enml.global_search import Region
from mend.localization.enml.looks import Looks
from mend.localization.enml.problem import Floats, Indices
from mend.maps.compiled import compiled
from mend.maps.segment_grid import SegmentGrid

Bins = NDArray[np.uint16]
Logs = NDArray[np.float32]

MODEL = BeamModelParameters(
    hit_share=0.4,
    short_share=0.59,
    random_share=0.01,
    hit_deviation_m=0.1,
    short_decay_per_m=0.05,
)
"""Places are told apart by some centimetres, and by the walls that they would be seen through."""
_PLACES = 512
"""Twice as many change the logarithm by 0.3 in the median on the logs that were looked into."""
_BEARINGS = 180
_HEADINGS = 36
_CELL_M = 0.1
_STEPS = np.array([0.7548776662466927, 0.5698402909980532])
"""Of the Kronecker sequence that fills a square most evenly (Roberts 2018)."""


class Anywhere:
    """The mean likelihood of a scan over places and headings that are spread over a map.

    What the map shows from each place is cast once; a scan is then looked up. `mean_range_m` is how
    far away it is.
    """

    def __init__(
        self, grid: SegmentGrid, region: Region, model: BeamModelParameters = MODEL
    ) -> None:
        bearings = (np.arange(_BEARINGS) + 0.5) * 2.0 * np.pi / _BEARINGS
        corner = np.array([region.x_min, region.y_min])
        size = np.array([region.x_max, region.y_max]) - corner
        places = corner + size * np.mod(0.5 + np.outer(np.arange(_PLACES), _STEPS), 1.0)
        seen = [
            _bins(look_at(grid, np.append(each, 0.0), bearings, model.max_range_m)[0], model)
            for each in places
        ]
        self.mean_range_m = _CELL_M * (float(np.mean(seen)) + 0.5)
        # The headings of one beam stand side by side.
        twice_around = np.tile(seen, 2).reshape(_PLACES, 2 * _HEADINGS, _BEARINGS // _HEADINGS)
        self._expected = np.ascontiguousarray(twice_around.transpose(0, 2, 1))
        self.model = model
        middles = _CELL_M * (np.arange(round(model.max_range_m / _CELL_M), dtype=np.float64) + 0.5)
        self._logs: Logs = log_densities(middles[:, None], middles[None, :], model).astype(
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
        return most + float(np.log(np.exp(logs - most).mean(dtype=np.float64)))

    def mean_log_likelihood(self, looks: Looks) -> float:
        """Of some scans, per scan."""
        logs = []
        for first, last in pairwise(looks.starts):
            used = first + spread(last - first, self.model.beams)
            logs.append(self.log_likelihood(looks.ranges_m[used], looks.bearings[used]))
        return float(np.mean(logs))


def _bins(ranges: Floats, model: BeamModelParameters) -> Bins:
    last = round(model.max_range_m / _CELL_M) - 1
    return np.minimum(ranges / _CELL_M, last).astype(np.uint16)


@compiled
def score_anywhere(
    expected: Bins, logs: Logs, columns: Indices, ranges: Bins, headings: int
) -> Logs:
    """The sum of log densities at each place and heading, places by headings.

    `expected` is by place, by bearing within a heading's turn, and by heading, once around and as
    much again; of `logs` a row is for one measured range.
    """
    places, turn = expected.shape[:2]
    scores = np.zeros((places, headings), dtype=np.float32)
    for place in range(places):
        sums = scores[place]
        for beam in range(columns.shape[0]):
            of_range = logs[ranges[beam]]
            first, within = divmod(columns[beam], turn)
            here = expected[place, within, first : first + headings]
            for heading in range(headings):
                sums[heading] += of_range[here[heading]]
    return scores
