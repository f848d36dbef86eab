"""Whether somebody may come in, as whom, or how long they have to wait first."""

from dataclasses import dataclass

from server.access.principal import Caller


@dataclass(frozen=True, slots=True)
class Admission:
    """Who may come in; nobody without a `caller`. `wait_s`: so long no token of theirs is read."""

    caller: Caller | None
    wait_s: int = 0

    @property
    def retry_after(self) -> dict[str, str]:
        """The headers that say so."""
        return {"Retry-After": str(self.wait_s)}

    @property
    def too_many(self) -> str:
        """The sentence that says so."""
        return f"too many wrong tokens came from this address: try again in {self.wait_s} s"


REFUSED = Admission(None)
