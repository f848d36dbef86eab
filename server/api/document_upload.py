"""What is sent to have a document checked or kept."""

from pydantic import BaseModel, ConfigDict, ValidationError

from mend.errors import WrongInputError
from mend.server.api.mistakes import validation_sentences
from mend.tasks.scene import Name


class DocumentUpload(BaseModel):
    """A file as YAML or JSON text; `name` wins over the one in the file."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    name: Name | None = None
    text: str


def read_upload(body: bytes) -> DocumentUpload:
    """What a body in JSON says. Raises `WrongInputError`."""
    try:
        return DocumentUpload.model_validate_json(body)
    except ValidationError as error:
        sentences = validation_sentences(error.errors(include_url=False))
        raise WrongInputError("the upload cannot be used", sentences) from None
