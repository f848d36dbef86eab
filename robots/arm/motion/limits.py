"""How fast an arm may move."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class MotionLimits:
    """Bounds on every joint of an arm, and on the tool point along straight lines."""

    velocity_rad_s: float
    acceleration_rad_s2: float
    jerk_rad_s3: float
    tool_velocity_m_s: float

    def __post_init__(self) -> None:
        for name in self.__slots__:
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{name} is {getattr(self, name)}; a limit has to be above 0")
