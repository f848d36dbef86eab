"""Drives out of ROS bags: the same as the logs that they were written from, to the bit."""

import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from sampled import sample
from written_bag import (
    LASER_POSE,
    SCAN,
    BagFormat,
    BagMessages,
    Sent,
    messages_of,
    odometry_of,
    rounded,
    rounded_pose,
    stamps_of,
)

from mend.errors import WrongInputError
from mend.localization.bags.choice import BagChoice
from mend.localization.bags.reading import BagDrive, read_bag
from mend.localization.evaluation import follow
from mend.localization.logs.log import Log
from mend.localization.logs.reading import read_log
from mend.localization.methods import METHODS
from mend.localization.pose import compose, relative
from mend.maps.vector_map_file import read_vector_map

EXAMPLE = Path(__file__).parents[2] / "examples/localization"
FORMATS = list(BagFormat)
ANOTHER = BagChoice(poses="/amcl_pose")


def _log(steps: int = 40, mount: bool = True) -> Log:
    log = read_log(EXAMPLE / "drive.csv")
    kept = log.steps[:steps]
    if mount:
        kept = tuple(
            replace(each, scan=replace(each.scan, sensor_offset=LASER_POSE)) for each in kept
        )
    return replace(log, steps=kept)


def _drive(
    tmp_path: Path,
    change: Callable[[BagMessages, list[Sent]], list[Sent]] = lambda _, sent: sent,
    choice: BagChoice = ANOTHER,
    kind: BagFormat = BagFormat.MCAP,
    *,
    by_frames: bool = False,
) -> BagDrive:
    messages = BagMessages(kind)
    sent = messages_of(_log(), messages, by_frames=by_frames)
    return read_bag(messages.write(tmp_path / "drive", change(messages, sent)), choice)


def _same(drive: BagDrive, log: Log) -> None:
    assert len(drive) == len(log)
    assert np.array_equal(drive.references, log.references, equal_nan=True)
    for got, wanted in zip(drive.steps, log.steps, strict=True):
        assert np.array_equal(got.odometry, wanted.odometry)
        assert np.array_equal(got.scan.ranges, wanted.scan.ranges)
        assert np.array_equal(got.scan.sensor_offset, wanted.scan.sensor_offset)
        assert got.scan.angle_min == wanted.scan.angle_min
        assert got.scan.angle_increment == wanted.scan.angle_increment
        assert got.scan.max_range == wanted.scan.max_range
        assert got.scan.time_s == wanted.scan.time_s


@pytest.mark.parametrize("by_frames", [False, True], ids=["topic", "tf"])
@pytest.mark.parametrize("kind", FORMATS)
def test_a_bag_holds_what_the_log_held(tmp_path: Path, kind: BagFormat, by_frames: bool) -> None:
    drive = _drive(tmp_path, kind=kind, by_frames=by_frames)
    _same(drive, rounded(_log()))
    assert drive.skipped == 0
    assert drive.start is not None


@pytest.mark.slow(seconds=4)
@pytest.mark.parametrize(
    ("kind", "method"),
    sample([(FORMATS[0], "enml"), (FORMATS[-1], "mcl")], list(product(FORMATS, ("enml", "mcl")))),
)
def test_the_estimates_are_the_same_to_the_bit(
    tmp_path: Path, kind: BagFormat, method: str
) -> None:
    vector_map = read_vector_map(EXAMPLE / "floor.vectormap.txt")
    traces = []
    for drive in (_drive(tmp_path, kind=kind), rounded(_log())):
        localizer = METHODS[method](vector_map, 3)
        assert drive.start is not None
        localizer.reset(drive.start)
        traces.append(follow(localizer, drive))
    assert np.array_equal(traces[0].poses, traces[1].poses)
    assert np.array_equal(traces[0].lost, traces[1].lost)


def test_a_bag_can_be_walked_again(tmp_path: Path) -> None:
    drive = _drive(tmp_path)
    first, second = list(drive.steps), list(drive.steps)
    assert np.array_equal(first[7].scan.ranges, second[7].scan.ranges)


def test_one_file_of_a_ros2_bag_is_a_bag(tmp_path: Path) -> None:
    _drive(tmp_path)
    (file,) = (tmp_path / "drive").glob("*.mcap")
    _same(read_bag(file, ANOTHER), rounded(_log()))


def test_odometry_between_two_messages_is_interpolated(tmp_path: Path) -> None:
    late_ns = 20_000_000

    def later(messages: BagMessages, sent: list[Sent]) -> list[Sent]:
        scans = [
            messages.scan(stamp + late_ns, step)
            for stamp, step in zip(stamps_of(_log())[:-1], _log().steps, strict=False)
        ]
        return [*(each for each in sent if each.type != SCAN), *scans]

    drive = _drive(tmp_path, later)
    places, stamps = odometry_of(_log()), stamps_of(_log())
    share = late_ns / (stamps[5] - stamps[4])
    wanted = places[4][:2] * (1 - share) + places[5][:2] * share
    got = np.zeros(3)
    for motion in drive.motions[1:5]:
        got = compose(got, motion)
    first_share = late_ns / (stamps[1] - stamps[0])
    moved = relative(np.zeros(3), places[1])
    first = np.array([*(moved[:2] * first_share), moved[2] * first_share])
    assert compose(first, got)[:2] == pytest.approx(wanted, abs=1e-4)


def test_between_two_poses_of_another_localizer_the_robot_goes_by_odometry(tmp_path: Path) -> None:
    def seldom(_: BagMessages, sent: list[Sent]) -> list[Sent]:
        poses = [each for each in sent if each.topic == "/amcl_pose"]
        return [each for each in sent if each not in (*poses[:3], *poses[4:])]

    drive = _drive(tmp_path, seldom)
    log = rounded(_log())
    assert np.isnan(drive.references[:3]).all()
    assert drive.start is None
    assert np.array_equal(drive.references[3], log.references[3])
    expected = compose(drive.references[3], log.steps[4].odometry)
    assert drive.references[4] == pytest.approx(expected, abs=1e-9)


def test_the_other_localizer_may_tell_its_poses_by_tf(tmp_path: Path) -> None:
    correction = [1.0, 2.0, 0.5]

    def corrected(messages: BagMessages, sent: list[Sent]) -> list[Sent]:
        told = messages.transform(stamps_of(_log())[2], "map", "odom", correction)
        return sorted([*sent, told], key=lambda each: each.stamp_ns)

    for by_frames in (True, False):
        folder = tmp_path / str(by_frames)
        folder.mkdir()
        drive = _drive(folder, corrected, BagChoice(poses="tf"), by_frames=by_frames)
        assert np.isnan(drive.references[1]).all()
        wanted = compose(np.array(correction), odometry_of(_log())[9])
        assert drive.references[9] == pytest.approx(wanted, abs=1e-9)


def test_a_laser_that_hangs_upside_down_is_turned_round(tmp_path: Path) -> None:
    def hung(messages: BagMessages, sent: list[Sent]) -> list[Sent]:
        stamp = stamps_of(_log())[0]
        mount = messages.transform(
            stamp, "base_link", "laser", LASER_POSE.tolist(), static=True, flipped=True
        )
        return [mount, *sent[1:]]

    drive = _drive(tmp_path, hung)
    step, log = next(iter(drive.steps)), rounded(_log())
    assert np.array_equal(step.scan.ranges, log.steps[0].scan.ranges[::-1])
    last = log.steps[0].scan.angles[-1]
    assert step.scan.angle_min == pytest.approx(-last)
    assert drive.told.endswith("upside down")


def test_what_is_nearer_than_the_sensor_sees_is_no_return(tmp_path: Path) -> None:
    def near(messages: BagMessages, _: list[Sent]) -> list[Sent]:
        log = _log()
        ranges = np.array([0.05, np.nan, np.inf, 9.0, 2.0], dtype=np.float32)
        sent = []
        for stamp, step, place in zip(stamps_of(log), log.steps, odometry_of(log), strict=True):
            sent.append(messages.odometry(stamp, place.tolist(), child="laser"))
            sent.append(messages.scan(stamp, step, range_min=0.1, ranges=ranges))
        return sent

    scan = next(iter(_drive(tmp_path, near, BagChoice()).steps)).scan
    assert scan.returns(0.0, 100.0).tolist() == [False, False, False, False, True]


def test_scans_with_another_number_of_beams_are_left_out(tmp_path: Path) -> None:
    def cut(messages: BagMessages, sent: list[Sent]) -> list[Sent]:
        scans = [number for number, each in enumerate(sent) if each.type == SCAN]
        step = _log().steps[4]
        short = messages.scan(stamps_of(_log())[4], step, ranges=np.ones(3, dtype=np.float32))
        sent[scans[4]] = short
        return sent

    drive = _drive(tmp_path, cut)
    assert drive.skipped == 1
    places = [rounded_pose(each) for each in odometry_of(_log())]
    assert np.array_equal(drive.motions[4], relative(places[3], places[5]))


@pytest.mark.parametrize(
    ("change", "choice", "said"),
    [
        (
            lambda _, sent: [each for each in sent if each.type != SCAN],
            ANOTHER,
            r"no sensor_msgs/LaserScan in it; it holds /amcl_pose \(geometry_msgs/PoseWith",
        ),
        (
            lambda _, sent: [*sent, Sent("/rear", SCAN, 10**18, sent[2].message)],
            ANOTHER,
            r"several lasers, say which with --scan: /rear \(sensor_msgs/LaserScan, 1 messages\), "
            r"/scan",
        ),
        (
            lambda m, sent: [*sent, m.odometry(10**18, [0, 0, 0], topic="/visual")],
            ANOTHER,
            r"several odometries, say which with --odometry: /odom .*, /visual .*, or tf",
        ),
        (
            lambda _, sent: [each for each in sent if each.topic != "/odom"],
            ANOTHER,
            r"neither nav_msgs/Odometry nor tf from 'odom' .* its tf has base_link -> laser",
        ),
        (
            lambda _, sent: sent[1:],
            ANOTHER,
            r"no tf tells where the laser 'laser' is on the robot 'base_link': give --base-frame, "
            r"or the laser's place with --laser-pose",
        ),
        (
            lambda _, sent: sent,
            BagChoice(poses="/pose"),
            r"'/pose' is no topic with PoseStamped, .* in it; it holds",
        ),
        (
            lambda _, sent: sent,
            BagChoice(poses="tf"),
            r"no tf tells where 'odom' is in 'map' \(--map-frame names another frame\)",
        ),
        (
            lambda _, sent: sent,
            BagChoice(scan="/odom"),
            r"'/odom' is no topic with LaserScan messages",
        ),
    ],
    ids=[
        "no scans",
        "two lasers",
        "two odometries",
        "no odometry",
        "no laser's place",
        "no such topic",
        "no tf of a map",
        "another type",
    ],
)
def test_what_a_bag_does_not_tell_is_asked_for(
    tmp_path: Path,
    change: Callable[[BagMessages, list[Sent]], list[Sent]],
    choice: BagChoice,
    said: str,
) -> None:
    with pytest.raises(WrongInputError, match=said):
        _drive(tmp_path, change, choice)


def test_a_topic_is_chosen_by_name_and_the_laser_put_in_place(tmp_path: Path) -> None:
    def two(messages: BagMessages, sent: list[Sent]) -> list[Sent]:
        more = [messages.odometry(10**18, [0, 0, 0], topic="/visual")]
        return [*sent[1:], *more, Sent("/rear", SCAN, 10**18, sent[2].message)]

    choice = BagChoice("scan", "/odom", "/amcl_pose", laser_pose=LASER_POSE)
    _same(_drive(tmp_path, two, choice), rounded(_log()))


def test_an_odometry_that_is_to_be_judged_is_not_driven_by(tmp_path: Path) -> None:
    def told(messages: BagMessages, sent: list[Sent]) -> list[Sent]:
        places = zip(stamps_of(_log()), _log().references, strict=True)
        return sent + [messages.odometry(at, pose, topic="/global") for at, pose in places]

    _same(_drive(tmp_path, told, BagChoice(poses="global")), rounded(_log()))


@pytest.mark.parametrize("kind", FORMATS)
def test_an_empty_bag_is_refused(tmp_path: Path, kind: BagFormat) -> None:
    with pytest.raises(WrongInputError, match="the bag is empty"):
        read_bag(BagMessages(kind).write(tmp_path / "nothing", []))


def test_a_bag_of_words_alone_is_refused(tmp_path: Path) -> None:
    with pytest.raises(WrongInputError, match=r"it holds /words \(std_msgs/String, 1 messages\)"):
        _drive(tmp_path, lambda m, _: [m.words(5, "hello")])


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.97])
@pytest.mark.parametrize("kind", FORMATS)
def test_a_bag_that_is_cut_off_is_refused(tmp_path: Path, kind: BagFormat, share: float) -> None:
    messages = BagMessages(kind)
    path = messages.write(tmp_path / "drive", messages_of(_log(), messages))
    file = (
        path if path.is_file() else next(each for each in path.iterdir() if "yaml" not in each.name)
    )
    whole = file.read_bytes()
    file.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(WrongInputError, match="bag"):
        list(read_bag(path, ANOTHER).steps)


def test_a_folder_without_metadata_is_no_bag(tmp_path: Path) -> None:
    with pytest.raises(WrongInputError, match=r"a ROS 2 bag's folder has a metadata\.yaml"):
        read_bag(tmp_path)


def test_a_text_that_is_called_a_bag_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "words.bag"
    path.write_text("Dear diary")
    with pytest.raises(WrongInputError, match="no bag that can be read"):
        read_bag(path)


@pytest.mark.slow(seconds=3)
@pytest.mark.parametrize("kind", FORMATS)
def test_a_bag_is_never_in_memory_as_a_whole(tmp_path: Path, kind: BagFormat) -> None:
    log, messages = _log(), BagMessages(kind)
    ranges = np.linspace(1.0, 5.0, 20_000, dtype=np.float32)
    sent: list[Sent] = []
    for number in range(400):
        stamp = stamps_of(log)[0] + number * 10**8
        sent.append(messages.odometry(stamp, [0.1 * number, 0.0, 0.0], child="laser"))
        sent.append(messages.scan(stamp, log.steps[0], ranges=ranges))
    path = messages.write(tmp_path / "long", sent)
    del sent
    tracemalloc.start()
    try:
        assert sum(1 for _ in read_bag(path).steps) == 400
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 400 * ranges.nbytes / 3
