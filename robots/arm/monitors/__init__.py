"""Fault monitors of an arm: each watches for one kind of issue in some phases of some behaviors."""

from mend.robots.arm.monitors.monitor import ArmMonitor, ArmView

__all__ = ["ArmMonitor", "ArmView"]
