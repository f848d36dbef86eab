"""What a part of a document may say, and nothing else."""

from pydantic import BaseModel, ConfigDict


class StrictModel(BaseModel):
    """A model that takes neither unknown fields nor values of another type."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)
