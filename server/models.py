"""The model files of robots: what the simulators draw them from, for others to draw them too."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from mend.errors import NotFoundError
from mend.sim.world import ModelProvider, WorldAdapter, WorldUnavailableError

URDF = "robot.urdf"
_KINDS = frozenset({".urdf", ".stl", ".dae", ".png", ".jpg"})


class RobotModels:
    """The models of the worlds' robots, by name."""

    def __init__(self, adapters: Iterable[WorldAdapter]) -> None:
        self._providers: Mapping[str, ModelProvider] = {
            each.model: each for each in adapters if isinstance(each, ModelProvider)
        }

    def address(self, model: str) -> str | None:
        """Where a model's description is served; None where its files are not here."""
        try:
            self.file(model, URDF)
        except NotFoundError:
            return None
        return f"/api/models/{model}/{URDF}"

    def file(self, model: str, name: str) -> Path:
        """A file of a model; `name` is relative to its description. Raises `NotFoundError`."""
        provider = self._providers.get(model)
        if provider is None:
            raise NotFoundError(f"there is no robot model '{model}'")
        try:
            folder = provider.model_folder().resolve()
        except WorldUnavailableError as error:
            raise NotFoundError(f"the robot model '{model}' is not here: {error}") from error
        missing = NotFoundError(f"the robot model '{model}' has no file of this name")
        try:
            found = (folder / name).resolve()
            wanted = found.is_relative_to(folder) and found.suffix in _KINDS and found.is_file()
        except (ValueError, OSError):
            # A name that no file can have, as one with a null byte in it or one too long.
            raise missing from None
        if not wanted:
            raise missing
        return found
