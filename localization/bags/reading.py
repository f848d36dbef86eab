"""A bag's drive: scans streamed from the file, all else read once and kept as numbers."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mend.errors import WrongInputError
from mend.localization.bags.bag import Bag, Received, Topic
from mend.localization.bags.choice import (
    BagChoice,
    base_below,
    odometry_topic,
    pose_topics,
    scan_topic,
)
from mend.localization.bags.frames import Frames, frame_name
from mend.localization.bags.laser import STEEPEST_RAD, is_level, mounts_of, scan_of
from mend.localization.bags.odometry import OdometrySource, odometry_of
from mend.localization.bags.poses import poses_of
from mend.localization.bags.rigid import Rigid
from mend.localization.bags.stamps import stamp_of
from mend.localization.bags.track import Between, Stamps
from mend.localization.logs.log import LogStep
from mend.localization.pose import Poses, relative
from mend.localization.scan import InvalidScanError


@dataclass(frozen=True, slots=True, eq=False)
class _Sweeps:
    """What is kept of the scans: when each was, and which of them are used."""

    stamps: Stamps
    frame: str
    usable: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class BagDrive:
    """A recorded drive whose scans are read anew from the bag whenever its steps are walked."""

    name: str
    bag: Bag
    scans: Topic
    told: str
    """What was chosen, in words."""
    used: NDArray[np.bool_]
    """Which of the topic's messages are steps; what follows is by these steps."""
    stamps: Stamps
    motions: Poses
    mounts: Poses
    upside_down: NDArray[np.bool_]
    references: Poses

    def __len__(self) -> int:
        return len(self.motions)

    @property
    def skipped(self) -> int:
        """How many scans could not be used."""
        return len(self.used) - len(self)

    @property
    def start(self) -> Poses | None:
        """The reference pose of the first step, if there is one."""
        known = bool(len(self)) and bool(np.isfinite(self.references[0]).all())
        return self.references[0] if known else None

    @property
    def steps(self) -> Iterator[LogStep]:
        """The steps in their order, one scan in memory at a time. Raises `WrongInputError`."""
        number = 0
        time_s = -np.inf
        messages = self.bag.messages([self.scans])
        for received, used in zip(messages, self.used, strict=True):
            if not used:
                continue
            # Clocks of some robots were set while they drove; the order is what counts.
            time_s = max(time_s, float(self.stamps[number]) / 1e9)
            scan = scan_of(
                received.message,
                time_s,
                self.mounts[number],
                upside_down=bool(self.upside_down[number]),
            )
            reference = self.references[number]
            known = bool(np.isfinite(reference).all())
            yield LogStep(self.motions[number], scan, reference if known else None)
            number += 1

    def path_m(self) -> float:
        """How far the robot drove: along the references where all are known, else by odometry."""
        return self._path_m

    @cached_property
    def _path_m(self) -> float:
        steps = self.motions
        if len(self) and np.isfinite(self.references).all():
            steps = np.diff(self.references, axis=0)
        return float(np.hypot(steps[:, 0], steps[:, 1]).sum())


def read_bag(path: Path, choice: BagChoice | None = None) -> BagDrive:
    """The drive of a bag: `.bag`, `.db3`, `.mcap`, or a ROS 2 bag's folder.

    Raises `WrongInputError`, which lists what the bag holds where a topic has to be chosen, or
    `OSError`.
    """
    its = choice or BagChoice()
    bag = Bag(path)
    scans = scan_topic(bag, its)
    frames = Frames.of(bag)
    chosen = odometry_topic(bag, its, frames)
    sweeps = _sweeps(bag, scans)
    if chosen is None:
        odometry = OdometrySource.of_frames(frames, its.odom_frame, base_below(bag, its, frames))
    else:
        odometry = odometry_of(bag, chosen, its)
    places = odometry.at(sweeps.stamps)
    mounts = _mounts(bag, its, frames, odometry.base_frame, sweeps)
    used = sweeps.usable & np.isfinite(places).all(axis=1) & np.isfinite(mounts).all(axis=1)
    if not used.any():
        raise WrongInputError(
            f"{path}: none of its {len(used)} scans can be used: odometry "
            f"({odometry.told}) and scans ({scans.name}) are not from the same time, or the scans "
            "hold no ranges"
        )
    stamps = sweeps.stamps[used]
    references = np.full((len(stamps), 3), np.nan)
    if its.poses is not None:
        references = poses_of(bag, its, frames, odometry, stamps)
    driven = places[used]
    motions = np.concatenate((np.zeros((1, 3)), relative(driven[:-1], driven[1:])))
    planar_mounts, upside_down = mounts_of(mounts[used])
    x, y, theta = planar_mounts[0]
    told = (
        f"{path}: scans from {scans.name}, odometry from {odometry.told}, laser '{sweeps.frame}' "
        f"at {x:.3f}, {y:.3f} m and {np.degrees(theta):.1f} degrees in '{odometry.base_frame}'"
        + (", upside down" if upside_down[0] else "")
    )
    return BagDrive(
        path.name.split(".")[0],
        bag,
        scans,
        told,
        used,
        stamps,
        motions,
        planar_mounts,
        upside_down,
        references,
    )


def other_poses(path: Path) -> str:
    """The topics of a bag that may hold another localizer's poses, in words. Raises as `Bag`."""
    return ", ".join(str(each) for each in pose_topics(Bag(path)))


def _sweeps(bag: Bag, scans: Topic) -> _Sweeps:
    """A first walk over the scans. Raises `WrongInputError`."""
    stamps: list[int] = []
    beams: list[int] = []
    frames: Counter[str] = Counter()
    for received in bag.messages([scans]):
        stamps.append(stamp_of(received.message.header, received))
        beams.append(_beams(received))
        frames[frame_name(received.message.header.frame_id)] += 1
    if not stamps:
        raise WrongInputError(f"{bag.path}: the scans that it lists on {scans.name} are missing")
    usual = Counter(each for each in beams if each).most_common(1)
    most = usual[0][0] if usual else -1
    (frame, _), *others = frames.most_common()
    if others:
        raise WrongInputError(
            f"{bag.path}: the scans of {scans.name} come from several frames: {', '.join(frames)}"
        )
    return _Sweeps(np.array(stamps, dtype=np.int64), frame, np.array(beams) == most)


def _beams(received: Received) -> int:
    """How many beams a scan has; 0 where it is none."""
    try:
        return len(scan_of(received.message, 0.0, np.zeros(3), upside_down=False).ranges)
    except InvalidScanError:
        return 0


def _mounts(bag: Bag, choice: BagChoice, frames: Frames, base: str, sweeps: _Sweeps) -> Rigid:
    """Where the laser is on the robot at each scan. Raises `WrongInputError`."""
    count = len(sweeps.stamps)
    if choice.laser_pose is not None:
        x, y, theta = choice.laser_pose
        turned = (0.0, 0.0, np.sin(theta / 2.0), np.cos(theta / 2.0))
        return np.tile(np.array([x, y, 0.0, *turned]), (count, 1))
    if not frames.connected(base, sweeps.frame):
        raise WrongInputError(
            f"{bag.path}: no tf tells where the laser '{sweeps.frame}' is on the robot '{base}': "
            f"give --base-frame, or the laser's place with --laser-pose x,y,theta; {frames.told()}"
        )
    frames.read((base, sweeps.frame))
    mounts = frames.at(base, sweeps.frame, sweeps.stamps, Between.NEAREST)
    if not is_level(mounts):
        raise WrongInputError(
            f"{bag.path}: the laser '{sweeps.frame}' is tilted by more than "
            f"{np.degrees(STEEPEST_RAD):.0f} degrees, so that it sees no plane along the floor"
        )
    return mounts
