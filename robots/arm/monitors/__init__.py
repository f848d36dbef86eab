"""Fault monitors: each watches for one kind of issue in some phases of some behaviors."""

from mend.robots.arm.monitors.monitor import Monitor, MonitorView, Reaction

__all__ = ["Monitor", "MonitorView", "Reaction"]
