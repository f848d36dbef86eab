"""How long a base that stands before people waits until it asks them."""

from typing import Annotated

from pydantic import Field

from mend.documents.strict_model import StrictModel


class Asking(StrictModel):
    """Who sees it come may do at once what it is there for: it asks after `asks_s`."""

    asks_s: Annotated[float, Field(gt=0.0, le=600.0)] = 2.0
