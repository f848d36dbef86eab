"""How a part is built: a box, or a plate and the box of its knob on top."""

Size = tuple[float, float, float]
"""Full extents along x, y and z in metres."""


def boxes_of(size: Size, knob: Size | None) -> list[tuple[float, Size]]:
    """Each box's bottom above the part's (metres) and its extents, from the bottom up."""
    return [(0.0, size)] if knob is None else [(0.0, size), (size[2], knob)]


def height_of(size: Size, knob: Size | None) -> float:
    """From a part's bottom to its highest point, in metres."""
    bottom_m, top = boxes_of(size, knob)[-1]
    return bottom_m + top[2]
