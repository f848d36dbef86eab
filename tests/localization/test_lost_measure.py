"""The probability of having been carried, and the likelihood of a scan anywhere on a map."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.localization.beam_model import BeamModel, BeamModelParameters
from mend.localization.enml.anywhere import Anywhere
from mend.localization.enml.change import Comparison
from mend.localization.enml.global_search import Region
from mend.localization.enml.lost_measure import LOST_ABOVE, LostMeasure
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.scan import Scan
from mend.maps.ray_cast import cast
from mend.maps.segment_grid import segment_grid
from mend.maps.vector_map import VectorMap

ITS = EnmlParameters()
ROOM = VectorMap.of([[0, 0, 6, 0], [6, 0, 6, 4], [6, 4, 0, 4], [0, 4, 0, 0], [2, 0, 2, 1.5]])
MODEL = BeamModelParameters()


def test_with_nothing_to_tell_the_prior_adds_up_over_the_way() -> None:
    measure = LostMeasure(ITS)
    for _ in range(100):
        measure.weigh(1.0, Comparison(0.0), 0.0)
    odds = 100.0 * ITS.carried_per_m
    assert measure.probability == pytest.approx(odds / (1.0 + odds))


@pytest.mark.parametrize(
    ("strange", "elsewhere"),
    [(1e9, 0.0), (0.0, 1e9), (1e9, 1e9)],
    ids=["strange", "elsewhere", "both"],
)
def test_no_scan_decides_alone_and_some_in_a_row_do(strange: float, elsewhere: float) -> None:
    measure = LostMeasure(ITS)
    measure.weigh(1.0, Comparison(strange), elsewhere)
    assert measure.probability < LOST_ABOVE
    measure.weigh(1.0, Comparison(strange), elsewhere)
    assert measure.probability > LOST_ABOVE


def test_scans_from_hardly_different_places_count_for_little() -> None:
    near, far = LostMeasure(ITS), LostMeasure(ITS)
    for measure, apart_m in ((near, 0.01), (far, ITS.min_translation_m)):
        measure.begin(0.5)
        measure.weigh(apart_m, Comparison(0.0), 3.0)
    assert near.probability < 0.53
    assert far.probability > 0.9
    near.weigh(0.0, Comparison(1e9), 1e9)
    assert near.probability < 0.53


def test_what_looks_familiar_says_nothing_of_having_been_carried_before() -> None:
    measure = LostMeasure(ITS)
    measure.begin(0.4)
    for _ in range(20):
        measure.weigh(ITS.min_translation_m, Comparison(-10.0), 0.0)
    assert measure.probability >= 0.4
    strange = LostMeasure(ITS)
    strange.weigh(ITS.min_translation_m, Comparison(10.0), 0.0)
    before = strange.probability
    strange.weigh(ITS.min_translation_m, Comparison(-10.0), 0.0)
    assert strange.probability < before / 5.0


def test_what_is_strange_is_so_however_well_it_fits_the_map() -> None:
    measure = LostMeasure(ITS)
    for _ in range(3):
        measure.weigh(ITS.min_translation_m, Comparison(10.0), -1e9)
    assert measure.probability > LOST_ABOVE


def test_what_is_familiar_beside_a_strange_scan_says_nothing_of_before_that() -> None:
    doubts = []
    for is_with_familiar in (True, False):
        measure = LostMeasure(ITS)
        measure.weigh(1.0, Comparison(10.0), 0.0)
        strange = measure.probability
        measure.weigh(1.0, Comparison(-10.0, is_with_familiar), 0.0)
        doubts.append(measure.probability / strange)
    assert doubts[0] < 0.1
    assert doubts[1] >= 1.0


def test_it_knows_whether_the_map_alone_speaks_against_here() -> None:
    by_map, carried = LostMeasure(ITS), LostMeasure(ITS)
    carried.weigh(1.0, Comparison(10.0), 0.0)
    for measure in (by_map, carried):
        while measure.probability < LOST_ABOVE:
            measure.weigh(1.0, Comparison(-10.0, is_with_familiar=False), 2.0)
    assert by_map.is_by_map
    assert not carried.is_by_map


@given(
    st.lists(
        st.tuples(st.floats(0.0, 2.0), st.floats(-1e3, 1e3), st.floats(-1e3, 1e3)), max_size=200
    )
)
def test_it_stays_a_probability_and_comes_back(scans: list[tuple[float, float, float]]) -> None:
    measure = LostMeasure(ITS)
    for driven_m, strange, elsewhere in scans:
        measure.weigh(driven_m, Comparison(strange), elsewhere)
        assert 0.0 <= measure.probability <= 1.0
    for _ in range(20):
        measure.weigh(1.0, Comparison(-1e9), -1e9)
    assert measure.probability < 0.01


def test_it_begins_with_what_it_is_told() -> None:
    measure = LostMeasure(ITS)
    measure.begin(0.25)
    assert measure.probability == pytest.approx(0.25)
    measure.begin()
    assert measure.probability == 0.0


def anywhere_in(room: VectorMap) -> Anywhere:
    return Anywhere(segment_grid(room.segments), Region(*room.bounds), MODEL)


@given(x=st.floats(0.5, 5.5), y=st.floats(2.0, 3.5), heading=st.floats(-3.0, 3.0))
def test_a_scan_is_likelier_where_it_was_taken_than_anywhere(
    x: float, y: float, heading: float
) -> None:
    angles = np.linspace(-2.0, 2.0, MODEL.beams)
    ranges, _ = cast(ROOM.segments, x, y, heading + angles, 30.0)
    scan = Scan(ranges, -2.0, float(angles[1] - angles[0]), 30.0)
    model = BeamModel(ROOM)
    here = model.log_likelihood(np.array([x, y, heading]), model.beams_of(scan))
    assert here > anywhere_in(ROOM).log_likelihood(ranges, angles) + 3.0


def test_how_the_robot_stands_makes_no_difference_to_anywhere() -> None:
    angles = np.linspace(-2.0, 2.0, MODEL.beams)
    ranges, _ = cast(ROOM.segments, 3.0, 2.5, angles, 30.0)
    model = anywhere_in(ROOM)
    turned = model.log_likelihood(ranges, angles + np.radians(50.0))
    assert turned == pytest.approx(model.log_likelihood(ranges, angles), abs=1e-3)


def test_on_an_empty_map_anywhere_is_as_good_as_here() -> None:
    nothing = anywhere_in(VectorMap.of([]))
    assert np.isfinite(nothing.log_likelihood(np.array([1.0, 2.0]), np.array([0.0, 1.0])))
