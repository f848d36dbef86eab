"""The poses of another localizer at the times of the scans."""

import numpy as np

from mend.errors import WrongInputError
from mend.localization.bags.bag import POSE, Bag, Topic
from mend.localization.bags.choice import TF, BagChoice, pose_topic
from mend.localization.bags.frames import Frames
from mend.localization.bags.odometry import OdometrySource
from mend.localization.bags.rigid import chained, is_rigid, planar, rigid_of_pose
from mend.localization.bags.stamps import stamp_of
from mend.localization.bags.track import Between, Stamps, Track, TrackWriter
from mend.localization.pose import Poses, compose, relative


def poses_of(
    bag: Bag, choice: BagChoice, frames: Frames, odometry: OdometrySource, stamps: Stamps
) -> Poses:
    """The poses (n, 3) in the map's frame; NaN before the first. Raises `WrongInputError`.

    Between two messages the robot went by its odometry, which is what a localizer that corrects
    map -> odom now and then says too.
    """
    assert choice.poses is not None
    if choice.poses == TF:
        return _of_frames(frames, choice, odometry, stamps)
    told = _told_by(bag, pose_topic(bag, choice.poses))
    if not len(told):
        raise WrongInputError(f"{bag.path}: {choice.poses} holds no pose that is finite")
    number = np.searchsorted(told.stamps, stamps, side="right") - 1
    known = number >= 0
    newest = np.maximum(number, 0)
    poses = planar(told.transforms)[newest]
    since = relative(odometry.at(told.stamps)[newest], odometry.at(stamps))
    # At the very time of a message its pose counts as it is, to the bit.
    poses = np.where((told.stamps[newest] == stamps)[:, None], poses, compose(poses, since))
    poses[~known] = np.nan
    return poses


def _told_by(bag: Bag, topic: Topic) -> Track:
    written = TrackWriter()
    for received in bag.messages([topic]):
        message = received.message
        pose = message.pose if topic.type == POSE else message.pose.pose
        values = rigid_of_pose(pose)
        if is_rigid(values):
            written.add(stamp_of(message.header, received), values)
    return Track.of(written)


def _of_frames(
    frames: Frames, choice: BagChoice, odometry: OdometrySource, stamps: Stamps
) -> Poses:
    """What `tf` tells: map -> odom as last told, then the odometry."""
    correction = (choice.map_frame, odometry.odom_frame)
    if not frames.connected(*correction):
        raise WrongInputError(
            f"{frames.bag.path}: no tf tells where '{odometry.odom_frame}' is in "
            f"'{choice.map_frame}' (--map-frame names another frame); {frames.told()}"
        )
    frames.read(correction)
    held = frames.at(*correction, stamps, Between.HELD)
    return planar(chained(held, odometry.rigid_at(stamps)))
