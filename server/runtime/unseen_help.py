"""What a look saw that did not see the help that somebody had promised."""

from collections.abc import Mapping
from dataclasses import dataclass
from uuid import UUID, uuid4

from mend.dialogue.evidence import Point, has_moved
from mend.dialogue.script import Felt, Help, Sight
from mend.robots.link.messages import Detection
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.robot_proxy import RobotProxy

SEEN_BY_HEAD = (Help.PLACE, Help.PUT_BACK, Help.CLEAR_WAY)
"""Help of which a robot whose head camera shows nothing cannot say that there was none."""
_PUT_SOMEWHERE = (Help.PLACE, Help.PUT_BACK)
"""Help by which an object comes to be somewhere."""


@dataclass(frozen=True, slots=True)
class Unseen:
    """What there was instead; `blind`: why the camera could tell nothing.

    `jpeg` is what it showed, by the name under which the journal keeps that, and `detection` where
    in it the object is, and was to be.
    """

    felt: Felt | None = None
    blind: str | None = None
    sight: Sight | None = None
    jpeg: tuple[UUID, bytes] | None = None
    detection: Detection | None = None

    @property
    def picture(self) -> UUID | None:
        return None if self.jpeg is None else self.jpeg[0]

    @property
    def pictures(self) -> Mapping[UUID, bytes]:
        """What the journal is to keep."""
        return {} if self.jpeg is None else dict([self.jpeg])


def unseen_help(dialogue: DialogueState, proxy: RobotProxy, help_: Help) -> Unseen:
    """What a robot's last look saw instead of help."""
    return Unseen(
        felt=None if proxy.felt is None else Felt(proxy.felt),
        blind=proxy.blind if help_ in SEEN_BY_HEAD else None,
        sight=_sight(dialogue, proxy) if help_ in _PUT_SOMEWHERE else None,
        jpeg=None if proxy.jpeg is None else (uuid4(), proxy.jpeg),
        detection=proxy.detection,
    )


def _sight(dialogue: DialogueState, proxy: RobotProxy) -> Sight | None:
    name, first = dialogue.raised.object, dialogue.first_look
    if name is None or proxy.blind is not None:
        return None
    seen = proxy.seen.get(name)
    if seen is None:
        return Sight.NOWHERE
    at: Point = (seen.x, seen.y, seen.z)
    was = None if first is None else first.position
    return Sight.UNMOVED if was is not None and not has_moved(was, at) else Sight.ELSEWHERE
