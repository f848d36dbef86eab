"""What one robot perceives: what its head camera shows, what its hand feels, and both together."""

from mend.robots.perception.hand import FOREARM
from mend.robots.perception.head import HEAD
from mend.robots.perception.perception import Perception

__all__ = ["FOREARM", "HEAD", "Perception"]
