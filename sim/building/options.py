"""What a run may choose about a building."""

from enum import StrEnum
from typing import Annotated

from pydantic import ConfigDict, Field

from mend.documents.strict_model import StrictModel


class LocalizerKind(StrEnum):
    """How robots know where they are."""

    ENML = "enml"
    EXACT = "exact"


class BuildingOptions(StrictModel):
    """What a run may choose about the world."""

    model_config = ConfigDict(use_attribute_docstrings=True)

    shut_doors: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.2
    """The share of the doors that people open that is shut at first, drawn by the seed."""

    wrong_floors: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.0
    """How often somebody who presses a robot's button in an elevator presses another one."""
    blocked_hallways: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.0
    """Of the lanes along hallways, so many are blocked at first by people who stand there until a
    robot before them asks them to make way, drawn by the seed."""
    localizer: Annotated[LocalizerKind, Field(strict=False)] = LocalizerKind.ENML
    """How robots know where they are: by laser and wheels, or exactly."""
    unmapped: Annotated[float, Field(ge=0.0, le=0.5, strict=False)] = 0.2
    """Of what lasers see, so much is furniture that is on no map, drawn by the seed."""
    forgetful: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.0
    """How often who said that they put something into a basket, or take it out, forgets it, or
    takes something else."""
    battery_wh: Annotated[float, Field(ge=0.0, le=1e6, strict=False)] = 0.0
    """What a robot's battery holds when it begins; 0 never runs out."""
    carried_every_s: Annotated[float, Field(ge=0.0, le=1e6, strict=False)] = 0.0
    """About so often somebody carries a robot that drives to elsewhere on its floor; 0 is never."""
    no_shows: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.0
    """How often who is to be escorted does not come at all."""
    dawdling: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.1
    """How often, about every 10 s of the way, who is escorted stops for 5 to 60 s."""
    people: Annotated[int, Field(ge=0, le=100, strict=False)] = 0
    """So many people walk from room to room and sit there, as far as there are seats."""
