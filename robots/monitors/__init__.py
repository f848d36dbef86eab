"""Fault monitors: each watches for one kind of issue in some phases of some behaviors."""

from mend.robots.monitors.monitor import Meanwhile, Monitor, MonitorView

__all__ = ["Meanwhile", "Monitor", "MonitorView"]
