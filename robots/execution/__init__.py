"""What any body shares: executions of behaviors, held and resumed, watched by monitors by phase."""

from mend.robots.execution.behavior import Behavior
from mend.robots.execution.monitor import Monitor, MonitorView, Reaction
from mend.robots.execution.phase import Phase

__all__ = ["Behavior", "Monitor", "MonitorView", "Phase", "Reaction"]
