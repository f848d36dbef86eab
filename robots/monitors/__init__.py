"""Fault monitors: each watches for one kind of issue between two steps of a behavior."""

from robots.monitors.monitor import Meanwhile, Monitor, MonitorView

__all__ = ["Meanwhile", "Monitor", "MonitorView"]
