"""A small floor of our own: a corridor with offices on both sides."""

from mend.maps.vector_map import VectorMap

FLOOR = VectorMap.of(
    [
        # The outer walls.
        [0, 0, 24, 0],
        [24, 0, 24, 14],
        [24, 14, 0, 14],
        [0, 14, 0, 0],
        # The corridor's walls, with doors.
        [0, 6, 3, 6],
        [4.2, 6, 11, 6],
        [12.2, 6, 19, 6],
        [20.2, 6, 22, 6],
        [0, 8, 5, 8],
        [6.2, 8, 14, 8],
        [15.2, 8, 22, 8],
        # Between the offices.
        [8, 0, 8, 6],
        [16, 0, 16, 6],
        [10, 8, 10, 14],
        [22, 8, 22, 10],
        # A pillar and a niche.
        [4, 2.5, 4.5, 2.5],
        [4.5, 2.5, 4.5, 3],
        [4.5, 3, 4, 3],
        [4, 3, 4, 2.5],
        [17, 11, 18.5, 12],
    ],
    "floor",
)
