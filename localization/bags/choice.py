"""Which topics and frames of a bag are read: what the user says, else what there is one of."""

from dataclasses import dataclass

from mend.errors import WrongInputError
from mend.localization.bags.bag import (
    LASER_SCAN,
    ODOMETRY,
    POSE,
    POSE_WITH_COVARIANCE,
    Bag,
    Topic,
)
from mend.localization.bags.frames import Frames
from mend.localization.pose import Poses

TF = "tf"
"""Stands where a topic may be named: the transforms between the frames."""


@dataclass(frozen=True, slots=True, eq=False)
class BagChoice:
    """Topics and frames, None where the bag decides.

    `poses` is a topic with the poses of another localizer, or `tf`: map -> odom. `laser_pose` is
    where the laser sits on the robot, for a bag whose `tf` does not tell.
    """

    scan: str | None = None
    odometry: str | None = None
    poses: str | None = None
    base_frame: str | None = None
    odom_frame: str = "odom"
    map_frame: str = "map"
    laser_pose: Poses | None = None


def scan_topic(bag: Bag, choice: BagChoice) -> Topic:
    """The topic of the scans. Raises `WrongInputError`."""
    there = bag.of_type(LASER_SCAN)
    if choice.scan is not None:
        return _named(bag, choice.scan, there, "LaserScan")
    if len(there) == 1:
        return there[0]
    if there:
        raise WrongInputError(
            f"{bag.path}: there are several lasers, say which with --scan: {_listed(there)}"
        )
    raise WrongInputError(
        f"{bag.path}: there is no sensor_msgs/LaserScan in it; it holds {bag.contents()}"
    )


def odometry_topic(bag: Bag, choice: BagChoice, frames: Frames) -> Topic | None:
    """The topic of the odometry; None stands for `tf`. Raises `WrongInputError`."""
    there = bag.of_type(ODOMETRY)
    if choice.odometry == TF:
        return None
    if choice.odometry is not None:
        return _named(bag, choice.odometry, there, "Odometry")
    odometry = [each for each in there if not _is_called(each, choice.poses or "")]
    if len(odometry) == 1:
        return odometry[0]
    if odometry:
        raise WrongInputError(
            f"{bag.path}: there are several odometries, say which with --odometry: "
            f"{_listed(odometry)}, or tf"
        )
    if frames.children_of(choice.odom_frame):
        return None
    raise WrongInputError(
        f"{bag.path}: there is neither nav_msgs/Odometry nor tf from '{choice.odom_frame}' in it "
        f"(--odom-frame names another frame); it holds {bag.contents()}; {frames.told()}"
    )


def base_below(bag: Bag, choice: BagChoice, frames: Frames) -> str:
    """The robot's frame where odometry comes from `tf`. Raises `WrongInputError`."""
    if choice.base_frame is not None:
        return choice.base_frame
    below = frames.children_of(choice.odom_frame)
    if len(below) == 1:
        return below[0]
    raise WrongInputError(
        f"{bag.path}: say with --base-frame which frame below '{choice.odom_frame}' is the "
        f"robot's; {frames.told()}"
    )


def pose_topics(bag: Bag) -> list[Topic]:
    """The topics that may hold the poses of another localizer."""
    return bag.of_type(POSE, POSE_WITH_COVARIANCE, ODOMETRY)


def pose_topic(bag: Bag, name: str) -> Topic:
    """The topic of another localizer's poses, by name. Raises `WrongInputError`."""
    kinds = "PoseStamped, PoseWithCovarianceStamped or Odometry"
    return _named(bag, name, pose_topics(bag), kinds)


def _named(bag: Bag, name: str, there: list[Topic], kind: str) -> Topic:
    for each in there:
        if _is_called(each, name):
            return each
    raise WrongInputError(
        f"{bag.path}: '{name}' is no topic with {kind} messages in it; it holds {bag.contents()}"
    )


def _is_called(topic: Topic, name: str) -> bool:
    """Whether a topic has a name, which may be written without the slash before it."""
    return topic.name.lstrip("/") == name.lstrip("/")


def _listed(topics: list[Topic]) -> str:
    return ", ".join(str(each) for each in topics)
