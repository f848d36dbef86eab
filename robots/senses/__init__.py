"""What one robot perceives: what its head camera shows, what its hand feels, and both together."""

from mend.robots.senses.hand import FOREARM
from mend.robots.senses.head import HEAD
from mend.robots.senses.senses import Senses

__all__ = ["FOREARM", "HEAD", "Senses"]
