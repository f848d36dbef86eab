"""What a client asks of a site, checked at the edge."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, field_validator

from mend.server.runtime.requests import WorldOption
from mend.tasks.scenario import ScriptedIntervention


class FleetOptions(BaseModel):
    """How the robots of a building take what people ask for.

    `capacity`: what fits into a basket, in loads of requests; `transfer_places`: where things may
    change robots; `answers`: helpers (`live`), or a simulated person who always says yes, and does
    what was asked for (`late`: nobody answers the first question of a leg, nor when it is put
    again).
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    capacity: Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)] = 3.0
    transfer_places: Annotated[tuple[str, ...], Field(max_length=100, strict=False)] = ()
    answers: Literal["live", "yes", "late"] = "live"


class SiteRequest(BaseModel):
    """Open a site: a simulated world that stays, with its robots, for runs to come.

    `speed`: simulated seconds per second, or `max`. `fleet`: its robots take requests of people, in
    a building. `interventions`: what people do there, and when by its clock.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    scene: Annotated[str, Field(min_length=1, max_length=64)]
    world: Annotated[str, Field(min_length=1, max_length=64)] = "workcell"
    speed: Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)] | Literal["max"] = 1.0
    seed: Annotated[int, Field(ge=0, le=2**31 - 1)] = 0
    world_options: dict[str, WorldOption] = {}
    fleet: FleetOptions | None = None
    interventions: Annotated[list[ScriptedIntervention], Field(max_length=1000, strict=False)] = []

    @field_validator("interventions")
    @classmethod
    def _require_times(cls, given: list[ScriptedIntervention]) -> list[ScriptedIntervention]:
        if any(each.at_s is None for each in given):
            raise ValueError("what happens at a site happens at a time: give each 'at_s'")
        return given
