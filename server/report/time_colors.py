"""How pages call and colour the classes of time; colours that the colour-blind tell apart, too."""

from mend.server.report.leg_times import TimeUse

WORDS = {use: str(use) for use in TimeUse}
"""In the order in which they are stacked."""


def class_of(use: TimeUse) -> str:
    """The class of its shapes, as the page's style has it."""
    return f"use-{use.name.lower()}"
