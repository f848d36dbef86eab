"""How a transcript tells of people who steer a run, and of a run that waits for them."""

from mend.server.journal import events as ev


def told_word(event: ev.SteeringEvent) -> str:
    """What somebody has said of a node, after who it is."""
    return _DEEDS[type(event)].format(name=event.name) + because(event.reason)


def told_level(event: ev.AutonomySet) -> str:
    """How much the robots may do from now on, after who says so."""
    return f"sets the autonomy to {event.level}{because(event.reason)}"


def told_wait(event: ev.LeafHeld) -> str:
    """Before what a robot waits, and why."""
    return f"waits before {event.name}: {why_held(event)}"


def why_held(event: ev.LeafHeld) -> str:
    """Why a leaf does not begin by itself."""
    if event.breakpoint is None:
        return f"with autonomy {event.level} it asks first"
    return f"breakpoint set by {event.by}{because(event.reason)}"


def because(reason: str) -> str:
    """A reason after what it is for; nothing without one."""
    return f" ({reason})" if reason else ""


_DEEDS: dict[type[ev.SteeringEvent], str] = {
    ev.BreakpointSet: "sets a breakpoint before {name}",
    ev.BreakpointRemoved: "removes the breakpoint before {name}",
    ev.LeafLetGo: "lets {name} go on",
    ev.LeafPreferred: "asks for {name} next",
    ev.LeafNotPreferred: "no longer asks for {name} next",
    ev.LeafTriedAgain: "has {name} tried again",
}
