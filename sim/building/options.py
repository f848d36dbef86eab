"""What a run may choose about a building."""

from typing import Annotated

from pydantic import ConfigDict, Field

from mend.documents.strict_model import StrictModel


class BuildingOptions(StrictModel):
    """What a run may choose about the world."""

    model_config = ConfigDict(use_attribute_docstrings=True)

    shut_doors: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.2
    """The share of the doors that people open that is shut at first, drawn by the seed."""

    wrong_floors: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.0
    """How often somebody who presses a robot's button in an elevator presses another one."""
