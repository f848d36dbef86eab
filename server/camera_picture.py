"""What a robot's camera sees now."""

from dataclasses import dataclass

from mend.robots.link.messages import Detection


@dataclass(frozen=True, slots=True)
class CameraPicture:
    """A picture; `detection`: where in it is to be what the robot looks for, as far as it says."""

    jpeg: bytes
    detection: Detection | None = None
