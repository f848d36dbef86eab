"""What speaks for and against a robot's place: what it sees through, and what the map explains."""

import numpy as np

from mend.localization.enml.change import Strangeness, changed, recognized_points, seen_through
from mend.localization.enml.episode import Episode
from mend.localization.enml.motion_model import Travel
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.pose_node import PoseNode
from mend.localization.enml.prior import whitening_of
from mend.localization.points import scan_points
from mend.localization.pose import Poses, relative
from mend.localization.scan import Scan
from mend.maps.ray_cast import cast

ROOM = np.array([[-3, -2, 3, -2], [3, -2, 3, 2], [3, 2, -3, 2], [-3, 2, -3, -2]], dtype=np.float64)
HALL = 2.0 * ROOM
PERSON = np.array([[0.6, -0.5, 0.6, 0.5]])
HERE = np.zeros(3)


def seen(world: np.ndarray, pose: Poses) -> PoseNode:
    angles = np.linspace(-2.0, 2.0, 121)
    ranges, _ = cast(world, float(pose[0]), float(pose[1]), pose[2] + angles, 20.0)
    scan = Scan(ranges, -2.0, float(angles[1] - angles[0]), 20.0)
    return PoseNode.of(0, scan, scan_points(scan), Travel(), 0.15)


def test_driving_on_changes_nothing() -> None:
    on = np.array([0.5, 0.1, 0.3])
    assert changed(seen(ROOM, HERE), HERE, seen(ROOM, on), on) == 0.0


def test_what_comes_into_view_from_behind_an_edge_has_not_changed() -> None:
    edge = np.vstack([HALL, [[1.0, 0.3, 1.0, 4.0]]])
    on = np.array([1.5, 0.0, 0.4])
    assert changed(seen(edge, HERE), HERE, seen(edge, on), on) < 0.02


def test_who_steps_before_the_robot_appears_and_hides_what_did_not_vanish() -> None:
    alone, met = seen(ROOM, HERE), seen(np.vstack([ROOM, PERSON]), HERE)
    assert seen_through(met, HERE, alone, HERE) == 0.0
    assert 0.2 < changed(alone, HERE, met, HERE) < 0.4


def test_a_smaller_room_is_seen_through_from_a_larger() -> None:
    assert seen_through(seen(HALL, HERE), HERE, seen(ROOM, HERE), HERE) > 0.9
    assert changed(seen(ROOM, HERE), HERE, seen(HALL, HERE), HERE) > 0.9


def test_only_what_both_looked_at_is_compared() -> None:
    behind = np.array([0.0, 0.0, np.pi])
    assert changed(seen(ROOM, HERE), HERE, seen(ROOM, behind), behind) < 0.02
    assert changed(seen(ROOM, HERE), HERE, seen(HALL, behind), behind) > 0.9


def test_what_was_seen_before_is_recognized_after_driving_on() -> None:
    on = np.array([0.3, 0.1, 0.2])
    recognized = recognized_points(seen(ROOM, HERE), seen(ROOM, on), on, EnmlParameters())
    assert recognized.mean() > 0.8
    elsewhere = recognized_points(seen(ROOM, HERE), seen(HALL, on), on, EnmlParameters())
    assert elsewhere.mean() < 0.05


def test_what_faces_another_way_is_not_recognized() -> None:
    straight, slanted = ([[2.0, -1.0, 2.0 + lean, 1.0]] for lean in (0.0, 2.0))
    before, now = (seen(np.array(wall), HERE) for wall in (straight, slanted))
    gaps = now.scan_points.points[:, None] - before.scan_points.points
    near = np.hypot(*gaps.T).min(axis=0) < EnmlParameters().gate_m
    assert near.any()
    assert not recognized_points(before, now, HERE, EnmlParameters())[near].any()


def test_nothing_seen_is_nothing_changed() -> None:
    nowhere = np.array([50.0, 50.0, 0.0])
    assert changed(seen(ROOM, nowhere), HERE, seen(ROOM, HERE), HERE) == 0.0
    assert changed(seen(ROOM, HERE), HERE, seen(ROOM, nowhere), HERE) == 0.0


def episode_of(*way: tuple[np.ndarray, Poses]) -> Episode:
    """Of what is seen in worlds, at poses that are told rightly."""
    parameters = EnmlParameters()
    episode = Episode(parameters, way[0][1], whitening_of(np.eye(3)))
    for index, (world, pose) in enumerate(way):
        angles = np.linspace(-2.0, 2.0, 121)
        ranges, _ = cast(world, float(pose[0]), float(pose[1]), pose[2] + angles, 20.0)
        scan = Scan(ranges, -2.0, float(angles[1] - angles[0]), 20.0, float(index))
        motion = relative(way[index - 1][1], pose) if index else HERE
        episode.extend(motion, scan, scan_points(scan))
    return episode


def test_what_is_seen_again_speaks_against_having_been_carried() -> None:
    on = np.array([0.4, 0.1, 0.1])
    episode = episode_of((ROOM, HERE), (ROOM, on))
    assert Strangeness(EnmlParameters()).compare(episode, np.inf).strange < 0.0


def test_what_is_strange_is_so_until_the_last_familiar_scan_is_too_far_back() -> None:
    strangeness = Strangeness(EnmlParameters())
    on = [np.array([0.4 * step, 0.0, 0.0]) for step in range(6)]
    seen_so_far = [(ROOM, on[0])]
    told = []
    for pose in on[1:]:
        seen_so_far.append((HALL, pose))
        told.append(strangeness.compare(episode_of(*seen_so_far), np.inf))
    assert min(each.strange for each in told[:2]) > 5.0
    assert [each.is_with_familiar for each in told[:4]] == [True, True, False, True]
    assert [each.is_sudden for each in told[:3]] == [True, False, False]
    assert told[2].strange < 0.0, "it is beside one that was strange itself"


def test_a_few_points_that_are_not_recognized_tell_less_than_many() -> None:
    on = np.array([0.2, 0.0, 0.0])
    episode = episode_of((ROOM, HERE), (np.vstack([ROOM, PERSON]), on))
    earlier, later = episode.nodes
    persons = np.flatnonzero(~recognized_points(earlier, later, on, EnmlParameters()))
    told = []
    for count in (0, 1, len(persons)):
        later.is_ltf = np.ones(len(later.scan_points), dtype=np.bool_)
        later.is_ltf[persons[:count]] = False
        told.append(Strangeness(EnmlParameters()).compare(episode, np.inf).strange)
    assert told == sorted(told)
    assert told[2] > told[1] + 1.0


def test_of_scans_that_are_too_far_apart_nothing_is_said() -> None:
    episode = episode_of((ROOM, HERE), (HALL, np.array([0.5, 0.0, 0.0])))
    assert Strangeness(EnmlParameters()).compare(episode, 0.3).strange == 0.0
    assert Strangeness(EnmlParameters()).compare(episode, 0.6).strange > 0.0


def test_nothing_seen_is_neither_strange_nor_familiar() -> None:
    nowhere = np.array([[500.0, 500.0, 501.0, 500.0]])
    for worlds in ((nowhere, ROOM), (ROOM, nowhere)):
        episode = episode_of(*((world, HERE) for world in worlds))
        assert Strangeness(EnmlParameters()).compare(episode, np.inf).strange == 0.0
