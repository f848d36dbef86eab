"""What one robot perceives: what its head camera shows, what its hand feels, and both together."""

from mend.robots.arm.perception.hand import FOREARM
from mend.robots.arm.perception.head import HEAD
from mend.robots.arm.perception.perception import Perception

__all__ = ["FOREARM", "HEAD", "Perception"]
