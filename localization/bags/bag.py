"""A ROS bag as a stream of messages: ROS 1, or ROS 2 as SQLite or MCAP, by `rosbags`."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mend.errors import WrongInputError

LASER_SCAN = "sensor_msgs/msg/LaserScan"
ODOMETRY = "nav_msgs/msg/Odometry"
TRANSFORMS = "tf2_msgs/msg/TFMessage"
OLD_TRANSFORMS = "tf/msg/tfMessage"
POSE = "geometry_msgs/msg/PoseStamped"
POSE_WITH_COVARIANCE = "geometry_msgs/msg/PoseWithCovarianceStamped"

SUFFIXES = (".bag", ".db3", ".mcap")
_METADATA = "metadata.yaml"
_MOST_TOLD = 40


@dataclass(frozen=True, slots=True)
class Topic:
    """One topic of a bag; types are named as in ROS 2, whatever the bag is."""

    name: str
    type: str
    messages: int

    def __str__(self) -> str:
        return f"{self.name} ({self.type.replace('/msg/', '/')}, {self.messages} messages)"


@dataclass(frozen=True, slots=True)
class Received:
    """A message, on which topic it came, and when it was recorded (nanoseconds)."""

    topic: Topic
    recorded_ns: int
    message: Any


def is_bag(path: Path) -> bool:
    """Whether a path looks like a bag: by its end, or as a folder."""
    return path.is_dir() or path.suffix in SUFFIXES


class Bag:
    """What a bag holds; each call of `messages` reads the file anew, one message at a time."""

    def __init__(self, path: Path) -> None:
        """Raises `WrongInputError`, `OSError`, or `ModuleNotFoundError` without `rosbags`."""
        self.path = path
        path.stat()  # What is not there says so in the system's words.
        if path.is_dir() and not (path / _METADATA).exists():
            raise WrongInputError(f"{path}: a ROS 2 bag's folder has a {_METADATA}, this has none")
        with _opened(path) as reader:
            counted: dict[tuple[str, str], int] = {}
            for each in reader.connections:
                key = (each.topic, each.msgtype)
                counted[key] = counted.get(key, 0) + each.msgcount
        self.topics = [Topic(name, kind, count) for (name, kind), count in sorted(counted.items())]
        if not any(each.messages for each in self.topics):
            raise WrongInputError(f"{path}: the bag is empty")

    def of_type(self, *kinds: str) -> list[Topic]:
        """The topics of given types on which something came."""
        return [each for each in self.topics if each.type in kinds and each.messages]

    def messages(self, topics: Collection[Topic]) -> Iterator[Received]:
        """The messages of some topics as they were recorded. Raises `WrongInputError`."""
        wanted = {(each.name, each.type): each for each in topics}
        if not wanted:
            return
        with _opened(self.path) as reader:
            chosen = [each for each in reader.connections if (each.topic, each.msgtype) in wanted]
            coming = reader.messages(connections=chosen)
            while True:
                with _damage_told(self.path):
                    following = next(coming, None)
                    if following is None:
                        return
                    connection, recorded_ns, raw = following
                    message = reader.deserialize(raw, connection.msgtype)
                topic = wanted[connection.topic, connection.msgtype]
                yield Received(topic, recorded_ns, message)

    def contents(self) -> str:
        """The topics in words, for a sentence about what is missing among them."""
        told = [str(each) for each in self.topics[:_MOST_TOLD]]
        if len(self.topics) > _MOST_TOLD:
            told.append(f"{len(self.topics) - _MOST_TOLD} more")
        return ", ".join(told)


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    with _damage_told(path):
        # Older ROS 2 bags hold no definitions; of those used here no release has changed any.
        reader = AnyReader([path], default_typestore=get_typestore(Stores.LATEST))
        reader.open()
    try:
        yield reader
    finally:
        reader.close()


@contextmanager
def _damage_told(path: Path) -> Iterator[None]:
    """A damaged file raises whatever its parsers stumble over, not only what they foresee."""
    try:
        yield
    except OSError:
        raise
    except Exception as error:
        why = str(error).strip().rstrip(".") or type(error).__name__
        raise WrongInputError(
            f"{path}: no bag that can be read, or a damaged one: {why.splitlines()[0]}"
        ) from error
