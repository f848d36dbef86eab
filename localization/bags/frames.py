"""The frames of a bag (`tf` and `tf_static`): which hangs on which, and where it was when."""

from dataclasses import dataclass, field

import numpy as np

from mend.errors import WrongInputError
from mend.localization.bags.bag import OLD_TRANSFORMS, TRANSFORMS, Bag, Topic
from mend.localization.bags.rigid import (
    IDENTITY,
    Rigid,
    chained,
    inverted,
    is_rigid,
    rigid_of_transform,
)
from mend.localization.bags.stamps import stamp_of
from mend.localization.bags.track import Between, Stamps, Track, TrackWriter

_STATIC = "tf_static"


def frame_name(name: str) -> str:
    """A frame as ROS 2 names it: ROS 1 allowed a slash before it."""
    return name.lstrip("/")


@dataclass(slots=True)
class Frames:
    """The tree of frames; of those that move only the ones asked for are read."""

    bag: Bag
    parents: dict[str, str] = field(default_factory=dict)
    fixed: dict[str, Rigid] = field(default_factory=dict)
    """By the child's name, in its parent's frame."""
    _moving: dict[str, Track] = field(default_factory=dict)

    @classmethod
    def of(cls, bag: Bag) -> "Frames":
        """Read which frame hangs on which. Raises `WrongInputError`."""
        frames = cls(bag)
        for received in bag.messages(_topics(bag)):
            is_static = received.topic.name.endswith(_STATIC)
            for each in received.message.transforms:
                child = frame_name(each.child_frame_id)
                frames.parents[child] = frame_name(each.header.frame_id)
                values = rigid_of_transform(each.transform)
                if is_static and is_rigid(values):
                    frames.fixed[child] = np.array(values)
        return frames

    def children_of(self, frame: str) -> list[str]:
        """The frames that hang on a frame."""
        return sorted(child for child, parent in self.parents.items() if parent == frame)

    def connected(self, frame: str, other: str) -> bool:
        """Whether it can be told where one frame is in the other."""
        return frame == other or self._roots(frame)[-1] == self._roots(other)[-1]

    def read(self, *pairs: tuple[str, str]) -> None:
        """Read what moves between pairs of frames. Raises `WrongInputError`."""
        wanted = {
            child
            for frame, other in pairs
            for child in (*self._way_up(frame, other), *self._way_up(other, frame))
            if child not in self.fixed and child not in self._moving
        }
        if not wanted:
            return
        written = {child: TrackWriter() for child in wanted}
        for received in self.bag.messages(_topics(self.bag)):
            for each in received.message.transforms:
                child = frame_name(each.child_frame_id)
                values = rigid_of_transform(each.transform)
                if child in wanted and is_rigid(values):
                    written[child].add(stamp_of(each.header, received), values)
        for child, writer in written.items():
            self._moving[child] = Track.of(writer)

    def at(
        self, frame: str, other: str, stamps: Stamps, between: Between = Between.INTERPOLATED
    ) -> Rigid:
        """Where `other` is in `frame` at given stamps (n, 7), once read; NaN where unknown.

        Raises `WrongInputError` where the bag never tells.
        """
        if not self.connected(frame, other):
            raise WrongInputError(
                f"{self.bag.path}: no tf tells where '{other}' is in '{frame}'; {self.told()}"
            )
        down = self._along(self._way_up(other, frame), stamps, between)
        up = self._along(self._way_up(frame, other), stamps, between)
        if up is None or down is None:
            both = down if up is None else inverted(up)
            return np.tile(IDENTITY, (len(stamps), 1)) if both is None else both
        return chained(inverted(up), down)

    def told(self) -> str:
        """The tree in words."""
        if not self.parents:
            return "there is no tf in it"
        edges = [f"{parent} -> {child}" for child, parent in sorted(self.parents.items())]
        return f"its tf has {', '.join(edges[:40])}{', ...' if len(edges) > 40 else ''}"

    def _along(self, way: list[str], stamps: Stamps, between: Between) -> Rigid | None:
        whole: Rigid | None = None
        for child in way:
            if child in self.fixed:
                step = np.tile(self.fixed[child], (len(stamps), 1))
            else:
                step = self._moving[child].at(stamps, between)
            whole = step if whole is None else chained(step, whole)
        return whole

    def _roots(self, frame: str) -> list[str]:
        """A frame and those that it hangs on, up to the last."""
        line = [frame]
        while (above := self.parents.get(line[-1])) is not None and above not in line:
            line.append(above)
        return line

    def _way_up(self, frame: str, other: str) -> list[str]:
        """The frames from one up to what it has in common with another, that one left out."""
        above = set(self._roots(other))
        way: list[str] = []
        for each in self._roots(frame):
            if each in above:
                break
            way.append(each)
        return way


def _topics(bag: Bag) -> list[Topic]:
    return bag.of_type(TRANSFORMS, OLD_TRANSFORMS)
