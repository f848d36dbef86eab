"""The model files of robots: of the simulators' own, and of robots that brought theirs."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from mend.errors import NotFoundError
from mend.server.models.archive_names import URDF
from mend.server.models.own_models import OwnModels
from mend.sim.world import ModelProvider, WorldAdapter, WorldUnavailableError

_KINDS = frozenset({".urdf", ".stl", ".dae", ".png", ".jpg"})


@dataclass(frozen=True, slots=True)
class DrawnModel:
    """Where a description is served, and whether its own colours are those of the robot.

    The descriptions of simulated robots have colours for debugging.
    """

    address: str
    own_colors: bool


class RobotModels:
    """All models by name; those of the worlds' robots come first."""

    def __init__(self, worlds: "WorldModels", own: OwnModels) -> None:
        self.worlds = worlds
        self.own = own

    def drawn(self, model: str) -> DrawnModel | None:
        """How a model is drawn; None where its files are not here."""
        address = self.worlds.address(model)
        if address is not None:
            return DrawnModel(address, own_colors=False)
        own = self.own.get(model)
        return None if own is None else DrawnModel(own_address(model, own.version), own_colors=True)


class WorldModels:
    """The models of the worlds' robots, by name."""

    def __init__(self, adapters: Iterable[WorldAdapter]) -> None:
        self._providers: Mapping[str, ModelProvider] = {
            each.model: each for each in adapters if isinstance(each, ModelProvider)
        }

    def __contains__(self, model: str) -> bool:
        return model in self._providers

    def names(self) -> list[str]:
        return sorted(self._providers)

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


def own_address(model: str, version: str) -> str:
    """Where the description of an uploaded model is: elsewhere for each version, as it is kept."""
    return f"/api/models/{quote(model, safe='')}/{version}/{URDF}"
