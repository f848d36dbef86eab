"""How robots may be drawn, as clients are told."""

from mend.server.runtime.views import View


class ModelFileView(View):
    """A file of a model, unpacked."""

    name: str
    bytes: int


class ModelView(View):
    """A model: `urdf` is where its description is, null where its files are not installed.

    `built_in` ones are those of worlds; `version` and `files` are told of uploaded ones.
    """

    name: str
    built_in: bool
    urdf: str | None
    version: str | None = None
    files: list[ModelFileView] = []
