"""Timing along a joint curve: jerk-limited, with a speed that may change on the way."""

import math

import numpy as np
from ruckig import InputParameter, OutputParameter, Result, Ruckig

from mend.errors import MendError
from mend.robots.arm.motion.curve import JointCurve
from mend.robots.arm.motion.kinematics import Joints
from mend.robots.arm.motion.limits import MotionLimits

_LEAST_SLOPE = 1e-9

_TURN_BACK = 1e-6
"""A motion that is slowed down at once would otherwise swing back; the generator wants a bound."""

_SLOWEST = 1e-3
"""Slower than this fraction of full speed a motion would never end."""


class TimedMotion:
    """Follows a joint curve from standstill to standstill, one control cycle at a time.

    Only the curve's parameter is timed (as one axis), so that the arm never leaves the curve
    however its speed is changed. With q(s) the joint velocity is q' v, the acceleration
    q'' v^2 + q' a and the jerk q''' v^3 + 3 q'' v a + q' j: the bounds on v, a and j keep each of
    these sums within the limits.
    """

    def __init__(
        self,
        curve: JointCurve,
        limits: MotionLimits,
        period_s: float,
        speed: float = 1.0,
        straight: bool = False,
    ) -> None:
        """The parameter of a `straight` curve is the tool's way in metres.

        Raises `ValueError` for a speed outside (0, 1].
        """
        self._curve = curve
        self._generator = Ruckig(1, period_s)
        self._input = InputParameter(1)
        self._output = OutputParameter(1)
        self._full_velocity = _bound_velocity(curve, limits, straight)
        self._input.target_position = [curve.length]
        self._input.min_velocity = [-_TURN_BACK]
        self._bound_acceleration(limits)
        self.set_speed(speed)
        self._parameter = 0.0
        self._finished = curve.length == 0.0

    @property
    def finished(self) -> bool:
        return self._finished

    @property
    def progress(self) -> float:
        """The fraction of the curve that is done."""
        if self._finished:
            return 1.0
        return min(1.0, self._parameter / self._curve.length)

    def rest(self) -> JointCurve:
        """What is left of the curve."""
        return self._curve.joined_from(self._curve.at(self._parameter))

    def set_speed(self, speed: float) -> None:
        """Scale the velocity from the next cycle on.

        Raises `ValueError` for a speed outside (0, 1].
        """
        if not 0.0 < speed <= 1.0:
            raise ValueError(f"a speed is above 0 and at most 1, not {speed}")
        self._input.max_velocity = [self._full_velocity * max(speed, _SLOWEST)]

    def advance(self) -> tuple[Joints, Joints]:
        """Let one control cycle pass; the joint angles and velocities (rad/s) to command."""
        if self._finished:
            return self._curve.end, np.zeros(len(self._curve.end))
        result = self._generator.update(self._input, self._output)
        if result not in (Result.Working, Result.Finished):
            raise MendError(f"no jerk-limited motion along the path was found ({result})")
        self._output.pass_to_input(self._input)
        self._finished = result == Result.Finished
        self._parameter = min(self._output.new_position[0], self._curve.length)
        velocity = self._output.new_velocity[0]
        return self._curve.at(self._parameter), self._curve.slope(self._parameter) * velocity

    def _bound_acceleration(self, limits: MotionLimits) -> None:
        """The velocity bound leaves half of each limit to these two."""
        slope, bend, twist = (self._curve.steepest(order) for order in (1, 2, 3))
        slope = max(slope, _LEAST_SLOPE)
        velocity = self._full_velocity
        acceleration = (limits.acceleration_rad_s2 - bend * velocity**2) / slope
        if bend > 0.0:
            acceleration = min(acceleration, limits.jerk_rad_s3 / 4 / (3 * bend * velocity))
        spent = twist * velocity**3 + 3 * bend * velocity * acceleration
        self._input.max_acceleration = [acceleration]
        self._input.max_jerk = [(limits.jerk_rad_s3 - spent) / slope]


def _bound_velocity(curve: JointCurve, limits: MotionLimits, straight: bool) -> float:
    """The highest velocity of the parameter that leaves room for acceleration and jerk."""
    slope, bend, twist = (curve.steepest(order) for order in (1, 2, 3))
    bounds = [limits.velocity_rad_s / max(slope, _LEAST_SLOPE)]
    if straight:
        bounds.append(limits.tool_velocity_m_s)
    if bend > 0.0:
        bounds.append(math.sqrt(limits.acceleration_rad_s2 / 2 / bend))
    if twist > 0.0:
        bounds.append(math.cbrt(limits.jerk_rad_s3 / 4 / twist))
    return min(bounds)
