"""Whether parts stand: on the table or on each other, and firmly."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product

import shapely

from mend.robots.arm.feasibility.stability import carried_by, stability_rad
from mend.robots.arm.feasibility.standing import Standing, beneath
from mend.tasks.scene import RESTS_M, Scene, Table
from mend.tasks.scene_problem import SceneProblem

OVER_EDGE_M = 0.01
"""So far a part may reach over the table's edge where the scatter has put it there."""
LEAST_STABILITY_RAD = math.radians(8.0)
"""What tips over when it leans by less does so when it is grasped, put down or touched."""


def cannot_stand(
    standing: Standing, others: Sequence[Standing], scene: Scene
) -> Iterator[SceneProblem]:
    """A part beyond the table, in the air or below the table, or that would tip over."""
    name, pose, table = standing.name, standing.pose, scene.table
    others = [each for each in others if each.where != standing.where]
    on_table = abs(standing.bottom_z - table.height) <= RESTS_M
    carriers = [] if on_table else beneath(standing, others)
    if not table.is_under(pose.x, pose.y):
        yield SceneProblem(standing.where, f"{name} at {_at(standing)} is beyond {_extents(table)}")
    elif on_table:
        if not _outline(table).buffer(1e-6).contains(standing.ground):
            yield SceneProblem(
                standing.where,
                f"{name} at {_at(standing)} reaches over the edge of {_extents(table)}",
            )
        elif not _stays_on_table(standing, scene):
            yield SceneProblem(
                ("scatter", "xy"),
                f"a scatter of {1e3 * scene.scatter.xy:g} mm may put {name}, at {_at(standing)}, "
                f"over the edge of {_extents(table)}: make it smaller, or move {name} inwards",
            )
        else:
            yield from _tips_over(standing, others, (), scene)
    elif not carriers:
        yield SceneProblem(standing.where, _in_the_air(standing, others, table))
    elif not _stays_on_others(standing, others, scene):
        below = " and ".join(each.name for each in carriers)
        yield SceneProblem(
            ("scatter", "xy"),
            f"a scatter of {1e3 * scene.scatter.xy:g} mm may put {name} off {below}, on which it "
            "starts, as each part is scattered by itself: make it smaller, or let it start on the "
            "table",
        )
    else:
        yield from _tips_over(standing, others, carriers, scene)


def _stays_on_others(standing: Standing, others: Sequence[Standing], scene: Scene) -> bool:
    """Whether a part that starts on others stands there wherever the scatter may put them."""
    apart_m = 2.0 * scene.scatter.xy
    if standing.where[0] != "objects" or apart_m == 0.0:
        return True
    weights = {name: each.mass_kg for name, each in scene.objects.items()}
    for dx, dy in product((-apart_m, apart_m), repeat=2):
        pose = standing.pose.model_copy(
            update={"x": standing.pose.x + dx, "y": standing.pose.y + dy}
        )
        shifted = replace(standing, pose=pose)
        carriers = beneath(shifted, others)
        if not carriers or stability_rad(shifted, carriers, others, weights) <= 0.0:
            return False
    return True


def _stays_on_table(standing: Standing, scene: Scene) -> bool:
    """Whether a part that starts on the table stands there wherever the scatter may put it.

    A little of it may then reach over the edge.
    """
    scatter, over_m = scene.scatter, min(OVER_EDGE_M, min(standing.part.size[:2]) / 4)
    if standing.where[0] != "objects" or (scatter.xy == 0.0 and scatter.yaw == 0.0):
        return True
    reach_m = scatter.xy - over_m
    outline, turns = _outline(scene.table).buffer(1e-6), (-scatter.yaw, 0.0, scatter.yaw)
    return all(
        outline.contains(shapely.box(x0 - reach_m, y0 - reach_m, x1 + reach_m, y1 + reach_m))
        for x0, y0, x1, y1 in (
            shapely.affinity.rotate(
                standing.ground, turn, origin=(standing.pose.x, standing.pose.y), use_radians=True
            ).bounds
            for turn in turns
        )
    )


def _tips_over(
    standing: Standing, others: Sequence[Standing], carriers: Sequence[Standing], scene: Scene
) -> Iterator[SceneProblem]:
    weights = {name: each.mass_kg for name, each in scene.objects.items()}
    lean_rad = stability_rad(standing, carriers, others, weights)
    if lean_rad >= LEAST_STABILITY_RAD:
        return
    on_it = [each.name for each in carried_by(standing, others)]
    name = f"{standing.name} with {' and '.join(on_it)} on it" if on_it else standing.name
    below = " and ".join(each.name for each in carriers)
    where = f"would tip off {below}" if carriers else "would tip over"
    if lean_rad > 0.0:
        # Rounded down: what is told has to be less than what is asked for.
        where += f" as soon as it leans by {math.floor(math.degrees(lean_rad))} degrees"
    mend = "put its middle further over what carries it" if carriers else "lay it on its side"
    yield SceneProblem(
        standing.where,
        f"{name} {where}, and has to stand leaning by {math.degrees(LEAST_STABILITY_RAD):.0f} "
        f"degrees: {mend}, or let it be lower or wider",
    )


def _in_the_air(standing: Standing, others: Sequence[Standing], table: Table) -> str:
    name, z = standing.name, standing.bottom_z
    if z < table.height:
        return (
            f"{name} at z {z:.3f} is below the table, whose top is at z {table.height:.3f}; "
            "leave z out to put it on the table"
        )
    under = [each for each in others if each.ground.intersects(standing.ground)]
    near = min(under, key=lambda each: abs(each.deck_z - z), default=None)
    if near is None:
        return (
            f"{name} at {_at(standing)} and z {z:.3f} is in the air: nothing is below it but the "
            f"table at z {table.height:.3f}; leave z out to put it there"
        )
    return (
        f"{name} at z {z:.3f} rests on nothing: the nearest top there is that of {near.name}, at z "
        f"{near.deck_z:.3f}"
    )


def _outline(table: Table) -> shapely.Polygon:
    (x, y), (length, width) = table.center, table.size
    return shapely.box(x - length / 2, y - width / 2, x + length / 2, y + width / 2)


def _at(standing: Standing) -> str:
    return f"({standing.pose.x:.3f}, {standing.pose.y:.3f})"


def _extents(table: Table) -> str:
    x0, y0, x1, y1 = _outline(table).bounds
    return f"the table, which is from x {x0:.2f} to {x1:.2f} and from y {y0:.2f} to {y1:.2f}"
