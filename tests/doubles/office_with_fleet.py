"""An office whose robots take requests, with somebody who does whatever they ask."""

import asyncio
from collections.abc import Mapping
from typing import Literal
from uuid import UUID

from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.server.composition import Service
from mend.server.sites.requests import FleetOptions, SiteRequest
from mend.sim.building.scene import scene_of
from mend.tasks.scene import Base


def office(floors: int = 1) -> Building:
    """Six rooms on each floor."""
    return Building(random_building(7, floors, 6))


async def open_office_with_fleet(
    service: Service,
    speed: float | Literal["max"] = 1.0,
    *,
    robots: int = 1,
    floors: int = 1,
    answers: Literal["live", "yes"] = "yes",
    stand: Mapping[str, Base] | None = None,
    **more: float,
) -> UUID:
    """Open a site there; its robots know where they are, and no door is shut.

    `stand`: where some of them begin. `more` are further options of the world. All have come, and
    can be sent somewhere.
    """
    scene = scene_of(office(floors), "office", robots)
    scene = scene.model_copy(update={"robots": {**scene.robots, **(stand or {})}})
    await service.library.scenes.save("office", scene.model_dump_json(exclude_defaults=True))
    site = await service.sites.open_site(
        SiteRequest(
            scene="office",
            world="building",
            speed=speed,
            seed=3,
            world_options={"localizer": "exact", "unmapped": 0.0, "shut_doors": 0.0, **more},
            fleet=FleetOptions(answers=answers),
        )
    )
    opened, names = service.sites.site(site.id), [each.robot for each in site.robots]
    while not all(opened.rests(robot) for robot in names):  # noqa: ASYNC110 - nothing tells of it
        await asyncio.sleep(0.01)
    return site.id
