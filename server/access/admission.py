"""Whether somebody may come in, as whom, or how long they have to wait first."""

from dataclasses import dataclass

from mend.server.access.principal import Caller


@dataclass(frozen=True, slots=True)
class Admission:
    """Who may come in; nobody without a `caller`.

    `wait_s`: so long nothing of theirs is read; `too_many` is the sentence that says why.
    """

    caller: Caller | None
    wait_s: int = 0
    too_many: str = ""

    @property
    def retry_after(self) -> dict[str, str]:
        """The headers that say so."""
        return {"Retry-After": str(self.wait_s)}


REFUSED = Admission(None)
