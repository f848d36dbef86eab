"""Where the robot was by its odometry: from a topic, or from `tf`."""

from collections.abc import Callable
from dataclasses import dataclass

from mend.errors import WrongInputError
from mend.localization.bags.bag import Bag, Topic
from mend.localization.bags.choice import BagChoice
from mend.localization.bags.frames import Frames, frame_name
from mend.localization.bags.rigid import Rigid, is_rigid, planar, rigid_of_pose
from mend.localization.bags.stamps import stamp_of
from mend.localization.bags.track import Stamps, Track, TrackWriter
from mend.localization.pose import Poses


@dataclass(frozen=True, slots=True, eq=False)
class OdometrySource:
    """The robot's pose in the odometry's frame, at any time."""

    odom_frame: str
    base_frame: str
    told: str
    rigid_at: Callable[[Stamps], Rigid]

    @classmethod
    def of_frames(cls, frames: Frames, odom_frame: str, base_frame: str) -> "OdometrySource":
        """What `tf` tells between two frames. Raises `WrongInputError`."""
        if not frames.connected(odom_frame, base_frame):
            raise WrongInputError(
                f"{frames.bag.path}: no tf tells where '{base_frame}' is in '{odom_frame}'; "
                f"{frames.told()}"
            )
        frames.read((odom_frame, base_frame))
        told = f"tf, {odom_frame} -> {base_frame}"
        return cls(
            odom_frame, base_frame, told, lambda stamps: frames.at(odom_frame, base_frame, stamps)
        )

    def at(self, stamps: Stamps) -> Poses:
        """The planar poses (n, 3); NaN where unknown."""
        return planar(self.rigid_at(stamps))


def odometry_of(bag: Bag, topic: Topic, choice: BagChoice) -> OdometrySource:
    """What a topic of `nav_msgs/Odometry` tells. Raises `WrongInputError`."""
    written = TrackWriter()
    parent = child = ""
    for received in bag.messages([topic]):
        message = received.message
        parent, child = frame_name(message.header.frame_id), frame_name(message.child_frame_id)
        values = rigid_of_pose(message.pose.pose)
        if is_rigid(values):
            written.add(stamp_of(message.header, received), values)
    base = choice.base_frame or child
    if not base:
        raise WrongInputError(
            f"{bag.path}: {topic.name} does not name the robot's frame; name it with --base-frame"
        )
    track = Track.of(written)
    return OdometrySource(parent or choice.odom_frame, base, topic.name, track.at)
