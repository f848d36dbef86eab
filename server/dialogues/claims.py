"""Claims: which helper is on which dialogue, so that the others need not be.

A claim is a courtesy with a lease; it never keeps anybody from answering.
"""

from dataclasses import dataclass
from datetime import datetime, timedelta
from uuid import UUID

from server.errors import ConflictError

LEASE = timedelta(seconds=30)


@dataclass(frozen=True, slots=True)
class Claim:
    """A helper is on a dialogue until the lease ends (wall time)."""

    helper: str
    until: datetime


class Claims:
    """The claims on all open dialogues; the wall time is passed in."""

    def __init__(self, lease: timedelta = LEASE) -> None:
        self._lease = lease
        self._claims: dict[UUID, Claim] = {}

    def claim(self, dialogue: UUID, helper: str, now: datetime) -> Claim:
        """Claim a dialogue, or renew one's own claim.

        Raises `ConflictError` while another helper's lease lasts.
        """
        self._require_not_another(dialogue, helper, now)
        claim = Claim(helper, now + self._lease)
        self._claims[dialogue] = claim
        return claim

    def release(self, dialogue: UUID, helper: str, now: datetime) -> None:
        """Give up one's own claim. Raises `ConflictError` when the helper has none."""
        self._require_not_another(dialogue, helper, now)
        if self.holder(dialogue, now) is None:
            raise ConflictError(f"{helper} has no claim on this dialogue to release")
        del self._claims[dialogue]

    def holder(self, dialogue: UUID, now: datetime) -> Claim | None:
        """The claim whose lease lasts, if there is one."""
        claim = self._claims.get(dialogue)
        return claim if claim is not None and now < claim.until else None

    def expire(self, now: datetime) -> dict[UUID, Claim]:
        """Forget, and return, every claim whose lease has run out."""
        expired = {
            dialogue: claim for dialogue, claim in self._claims.items() if claim.until <= now
        }
        for dialogue in expired:
            del self._claims[dialogue]
        return expired

    def next_expiry(self) -> datetime | None:
        """When the next lease runs out, if it is not renewed."""
        return min((claim.until for claim in self._claims.values()), default=None)

    def restore(self, dialogue: UUID, claim: Claim) -> None:
        """Take a claim over from the journal, whoever had one before."""
        self._claims[dialogue] = claim

    def drop(self, dialogue: UUID) -> None:
        """Forget whatever claim there is: the dialogue has closed, or the journal says released."""
        self._claims.pop(dialogue, None)

    def _require_not_another(self, dialogue: UUID, helper: str, now: datetime) -> None:
        held = self.holder(dialogue, now)
        if held is not None and held.helper != helper:
            seconds = (held.until - now).total_seconds()
            raise ConflictError(f"{held.helper} is on this dialogue for {seconds:.0f} s more")
