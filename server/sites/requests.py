"""What a client asks of a site, checked at the edge."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from mend.server.runtime.requests import WorldOption


class FleetOptions(BaseModel):
    """How the robots of a building take what people ask for.

    `capacity`: what fits into a basket, in loads of requests; `transfer_places`: where things may
    change robots; `answers`: helpers (`live`), or a simulated person who always says yes, and does
    what was asked for.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    capacity: Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)] = 3.0
    transfer_places: Annotated[tuple[str, ...], Field(max_length=100, strict=False)] = ()
    answers: Literal["live", "yes"] = "live"


class SiteRequest(BaseModel):
    """Open a site: a simulated world that stays, with its robots, for runs to come.

    `speed`: simulated seconds per second, or `max`. `fleet`: its robots take requests of people, in
    a building.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    scene: Annotated[str, Field(min_length=1, max_length=64)]
    world: Annotated[str, Field(min_length=1, max_length=64)] = "workcell"
    speed: Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)] | Literal["max"] = 1.0
    seed: Annotated[int, Field(ge=0, le=2**31 - 1)] = 0
    world_options: dict[str, WorldOption] = {}
    fleet: FleetOptions | None = None
