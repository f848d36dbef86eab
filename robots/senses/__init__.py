"""What one robot perceives: what its head camera shows, what its hand feels, and both together."""

from robots.senses.hand import FOREARM
from robots.senses.head import HEAD
from robots.senses.senses import Senses

__all__ = ["FOREARM", "HEAD", "Senses"]
