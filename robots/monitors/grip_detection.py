"""A forearm picture's reading as the detection that goes to the helper."""

from robots.link.messages import Detection
from robots.vision.forearm import GripReading


def describe_grip(grip: GripReading, how: str) -> Detection:
    """`how` the object is (or is not) where it must be, with what was seen."""
    return Detection(
        camera="forearm",
        center=None if grip.blob is None else grip.blob.center,
        expected=grip.expected,
        tolerance_px=grip.tolerance_px,
        area_px=0 if grip.blob is None else grip.blob.area_px,
        explanation=f"{grip.name} {how} where it must be between the fingers",
    )
