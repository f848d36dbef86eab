"""How much room a round base has that goes on with a velocity, on an arc, for some time."""

import math
from typing import Any

from mend.maps.compiled import compiled

_STRAIGHT_RAD_S = 1e-4
"""Who turns more slowly drives straight, by less than a millimetre."""


@compiled
def measure_room(points: Any, needs_m: Any, velocities: Any, times_s: Any, room_m: Any) -> None:
    """Write how much nearer than needed or farther the nearest point comes, at most what it says.

    `points` (n, 2) in the base's frame, of which each `needs_m` (n,) to its middle; `velocities`
    (m, 3): forward, left and turn, each held for one of `times_s` (m,). `room_m` (m,) holds the
    most that is of interest, and then what was found, negative where a point comes too near.
    """
    for number in range(velocities.shape[0]):
        forward, left = velocities[number, 0], velocities[number, 1]
        turn, time_s = velocities[number, 2], times_s[number]
        room = room_m[number]
        speed = math.sqrt(forward * forward + left * left)
        if speed < 1e-9:
            for point in range(points.shape[0]):
                x, y = points[point, 0], points[point, 1]
                room = min(room, math.sqrt(x * x + y * y) - needs_m[point])
        elif abs(turn) < _STRAIGHT_RAD_S:
            ahead_x, ahead_y, length_m = forward / speed, left / speed, speed * time_s
            for point in range(points.shape[0]):
                x, y = points[point, 0], points[point, 1]
                along = min(max(x * ahead_x + y * ahead_y, 0.0), length_m)
                dx, dy = x - along * ahead_x, y - along * ahead_y
                reach = room + needs_m[point]
                if reach > 0.0 and dx * dx + dy * dy >= reach * reach:
                    continue
                room = min(room, math.sqrt(dx * dx + dy * dy) - needs_m[point])
        else:
            middle_x, middle_y = -left / turn, forward / turn
            bend_m, swept = speed / abs(turn), abs(turn) * time_s
            sense = 1.0 if turn > 0.0 else -1.0
            cos, sin = math.cos(turn * time_s), math.sin(turn * time_s)
            end_x = middle_x - cos * middle_x + sin * middle_y
            end_y = middle_y - sin * middle_x - cos * middle_y
            for point in range(points.shape[0]):
                x, y = points[point, 0], points[point, 1]
                out_x, out_y = x - middle_x, y - middle_y
                from_arc = abs(math.sqrt(out_x * out_x + out_y * out_y) - bend_m)
                if from_arc - needs_m[point] >= room:
                    continue
                cross = -middle_x * out_y + middle_y * out_x
                dot = -middle_x * out_x - middle_y * out_y
                at = math.atan2(sense * cross, dot)
                if at < 0.0:
                    at += 2.0 * math.pi
                if at > swept:
                    to_start = math.sqrt(x * x + y * y)
                    to_end = math.sqrt((x - end_x) ** 2 + (y - end_y) ** 2)
                    from_arc = min(to_start, to_end)
                room = min(room, from_arc - needs_m[point])
        room_m[number] = room
