"""What runs may choose about their world: read at the edge, one sentence for what is wrong."""

from collections.abc import Mapping
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from mend.documents.problem import list_names
from mend.documents.validation import describe_mistake
from mend.errors import WrongInputError

Options = TypeVar("Options", bound=BaseModel)


def read_options(model: type[Options], world: str, given: Mapping[str, Any]) -> Options:
    """The options of a world, as its adapter's model has them; raises `WrongInputError`."""
    try:
        return model.model_validate(dict(given))
    except ValidationError as error:
        mistake = error.errors(include_url=False)[0]
    name = mistake["loc"][0] if mistake["loc"] else None
    if mistake["type"] != "extra_forbidden":
        said = f"an option of the world '{world}' is wrong: {describe_mistake(mistake, model)}"
    elif model.model_fields:
        known = list_names(model.model_fields)
        said = f"the world '{world}' has no option '{name}'; it has {known}"
    else:
        said = f"the world '{world}' has no options, but '{name}' is given"
    raise WrongInputError(said)
