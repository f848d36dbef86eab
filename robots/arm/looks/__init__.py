"""Looks: one look at everything, or looking until what is expected has come to be."""

from mend.robots.arm.looks.look import look_as_told
from mend.robots.arm.looks.looker import Looker

__all__ = ["Looker", "look_as_told"]
