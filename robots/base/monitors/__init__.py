"""Fault monitors of a base: each watches for one kind of issue in some phases of some behaviors."""

from mend.robots.base.monitors.monitor import BaseMonitor, BaseView

__all__ = ["BaseMonitor", "BaseView"]
