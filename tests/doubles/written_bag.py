"""Bags that tests write from logs, and those logs rounded to what a bag's messages can hold."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore

from mend.localization.bags.rigid import planar
from mend.localization.logs.log import Log, LogStep
from mend.localization.pose import Poses, compose, relative

LASER_POSE = np.array([0.12, -0.03, 0.25])


class BagFormat(Enum):
    ROS1 = ".bag"
    SQLITE = "sqlite3"
    MCAP = "mcap"


@dataclass(frozen=True, slots=True)
class Sent:
    """One message: topic, type, time in nanoseconds, and its fields."""

    topic: str
    type: str
    stamp_ns: int
    message: Any


@dataclass(slots=True)
class BagMessages:
    """Makes messages as a bag's format has them."""

    format: BagFormat
    store: Typestore = field(init=False)

    def __post_init__(self) -> None:
        ros1 = self.format is BagFormat.ROS1
        self.store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
        if ros1:
            self.store.register(
                {"tf2_msgs/msg/TFMessage": get_typestore(Stores.LATEST).fielddefs[TRANSFORMS]}
            )

    def of(self, kind: str, **fields: Any) -> Any:
        return self.store.types[kind](**fields)

    def header(self, stamp_ns: int, frame: str) -> Any:
        stamp = self.of(
            "builtin_interfaces/msg/Time", sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9
        )
        more = {"seq": 0} if self.format is BagFormat.ROS1 else {}
        return self.of("std_msgs/msg/Header", stamp=stamp, frame_id=frame, **more)

    def scan(self, stamp_ns: int, step: LogStep, frame: str = "laser", **changed: Any) -> Sent:
        scan = step.scan
        fields = {
            "header": self.header(stamp_ns, frame),
            "angle_min": scan.angle_min,
            "angle_max": scan.angle_min + scan.angle_increment * (len(scan.ranges) - 1),
            "angle_increment": scan.angle_increment,
            "time_increment": 0.0,
            "scan_time": 0.0,
            "range_min": 0.0,
            "range_max": scan.max_range,
            "ranges": scan.ranges.astype(np.float32),
            "intensities": np.zeros(0, dtype=np.float32),
        } | changed
        return Sent("/scan", SCAN, stamp_ns, self.of(SCAN, **fields))

    def pose(self, pose: Sequence[float]) -> Any:
        place = self.of("geometry_msgs/msg/Point", x=pose[0], y=pose[1], z=0.0)
        return self.of(
            "geometry_msgs/msg/Pose", position=place, orientation=self.quaternion(pose[2])
        )

    def quaternion(self, heading: float, *, flipped: bool = False) -> Any:
        x, y, z, w = quaternion(heading, flipped=flipped)
        return self.of("geometry_msgs/msg/Quaternion", x=x, y=y, z=z, w=w)

    def odometry(
        self, stamp_ns: int, pose: Sequence[float], topic: str = "/odom", child: str = "base_link"
    ) -> Sent:
        zero = self.of("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)
        covariance = np.zeros(36)
        message = self.of(
            ODOMETRY,
            header=self.header(stamp_ns, "odom"),
            child_frame_id=child,
            pose=self.of(
                "geometry_msgs/msg/PoseWithCovariance", pose=self.pose(pose), covariance=covariance
            ),
            twist=self.of(
                "geometry_msgs/msg/TwistWithCovariance",
                twist=self.of("geometry_msgs/msg/Twist", linear=zero, angular=zero),
                covariance=covariance,
            ),
        )
        return Sent(topic, ODOMETRY, stamp_ns, message)

    def transform(
        self,
        stamp_ns: int,
        parent: str,
        child: str,
        pose: Sequence[float],
        *,
        static: bool = False,
        flipped: bool = False,
    ) -> Sent:
        moved = self.of("geometry_msgs/msg/Vector3", x=pose[0], y=pose[1], z=0.3)
        stamped = self.of(
            "geometry_msgs/msg/TransformStamped",
            header=self.header(stamp_ns, parent),
            child_frame_id=child,
            transform=self.of(
                "geometry_msgs/msg/Transform",
                translation=moved,
                rotation=self.quaternion(pose[2], flipped=flipped),
            ),
        )
        topic = "/tf_static" if static else "/tf"
        return Sent(topic, TRANSFORMS, stamp_ns, self.of(TRANSFORMS, transforms=[stamped]))

    def told_pose(
        self, stamp_ns: int, pose: Sequence[float], topic: str, *, with_covariance: bool
    ) -> Sent:
        kind = "geometry_msgs/msg/PoseWithCovarianceStamped" if with_covariance else POSE
        inner = self.pose(pose)
        if with_covariance:
            inner = self.of(
                "geometry_msgs/msg/PoseWithCovariance", pose=inner, covariance=np.zeros(36)
            )
        message = self.of(kind, header=self.header(stamp_ns, "map"), pose=inner)
        return Sent(topic, kind, stamp_ns, message)

    def words(self, stamp_ns: int, words: str) -> Sent:
        kind = "std_msgs/msg/String"
        return Sent("/words", kind, stamp_ns, self.of(kind, data=words))

    def write(self, path: Path, sent: Iterable[Sent]) -> Path:
        """Write a bag; its path is that of a file, or of a folder as ROS 2 makes one."""
        if self.format is BagFormat.ROS1:
            path = path.with_suffix(".bag")
            self._write(Writer1(path), sent)
        else:
            plugin = StoragePlugin[self.format.name.replace("SQLITE", "SQLITE3")]
            self._write(Writer2(path, version=9, storage_plugin=plugin), sent)
        return path

    def _write(self, writer: Any, sent: Iterable[Sent]) -> None:
        ros1 = self.format is BagFormat.ROS1
        to_bytes = self.store.serialize_ros1 if ros1 else self.store.serialize_cdr
        with writer:
            connections: dict[str, Any] = {}
            for each in sent:
                if each.topic not in connections:
                    connections[each.topic] = writer.add_connection(
                        each.topic, each.type, typestore=self.store
                    )
                writer.write(
                    connections[each.topic], each.stamp_ns, to_bytes(each.message, each.type)
                )


SCAN = "sensor_msgs/msg/LaserScan"
ODOMETRY = "nav_msgs/msg/Odometry"
TRANSFORMS = "tf2_msgs/msg/TFMessage"
POSE = "geometry_msgs/msg/PoseStamped"


def quaternion(heading: float, *, flipped: bool = False) -> tuple[float, float, float, float]:
    """About the upward axis; flipped, about the x axis by half a turn before."""
    sine, cosine = float(np.sin(heading / 2.0)), float(np.cos(heading / 2.0))
    return (cosine, sine, 0.0, 0.0) if flipped else (0.0, 0.0, sine, cosine)


def rounded_pose(pose: Poses) -> Poses:
    """A pose after its heading has been a quaternion."""
    return planar(np.array([pose[0], pose[1], 0.0, *quaternion(float(pose[2]))]))


def stamps_of(log: Log) -> list[int]:
    """When each scan was, in nanoseconds; no two at the same time."""
    first = 1_700_000_000 * 10**9
    times = [round((each.scan.time_s - log.steps[0].scan.time_s) * 1e9) for each in log.steps]
    return [first + time + number for number, time in enumerate(times)]


def odometry_of(log: Log) -> list[Poses]:
    """Where the robot is by its odometry, from the origin on."""
    place = np.zeros(3)
    places: list[Poses] = []
    for step in log.steps:
        place = compose(place, step.odometry)
        places.append(place)
    return places


def rounded(log: Log) -> Log:
    """A log as a bag can hold it: 32-bit ranges and angles, headings as quaternions."""
    places = [rounded_pose(each) for each in odometry_of(log)]
    steps: list[LogStep] = []
    for number, (step, stamp) in enumerate(zip(log.steps, stamps_of(log), strict=True)):
        scan = replace(
            step.scan,
            ranges=step.scan.ranges.astype(np.float32).astype(np.float64),
            angle_min=float(np.float32(step.scan.angle_min)),
            angle_increment=float(np.float32(step.scan.angle_increment)),
            max_range=float(np.float32(step.scan.max_range)),
            time_s=stamp / 1e9,
            sensor_offset=rounded_pose(step.scan.sensor_offset),
        )
        motion = relative(places[number - 1], places[number]) if number else np.zeros(3)
        reference = None if step.reference is None else rounded_pose(step.reference)
        steps.append(LogStep(motion, scan, reference))
    return replace(log, steps=tuple(steps))


def messages_of(log: Log, messages: BagMessages, *, by_frames: bool = False) -> list[Sent]:
    """A log as a robot would record it: scans, odometry, the laser's place, another's poses."""
    stamps = stamps_of(log)
    mount = log.steps[0].scan.sensor_offset
    sent = [
        messages.transform(stamps[0] - 10**9, "base_link", "laser", mount.tolist(), static=True)
    ]
    for stamp, step, place in zip(stamps, log.steps, odometry_of(log), strict=True):
        if by_frames:
            sent.append(messages.transform(stamp, "odom", "base_link", place.tolist()))
        else:
            sent.append(messages.odometry(stamp, place.tolist()))
        sent.append(messages.scan(stamp, step))
        if step.reference is not None:
            sent.append(
                messages.told_pose(
                    stamp, step.reference.tolist(), "/amcl_pose", with_covariance=True
                )
            )
    return sent
