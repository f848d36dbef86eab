"""Events of the service: its documents, and who came in."""

from typing import Literal
from uuid import UUID

from mend.server.access.roles import Role
from mend.server.journal.events.event import Author, EventModel, ServiceEvent


class DocumentKept(ServiceEvent):
    """A task tree, scene or scenario was uploaded; journaled as it is kept."""

    type: Literal["document_kept"] = "document_kept"
    kind: Literal["tree", "scene", "scenario"]
    name: str
    replaced: bool
    author: Author | None


class DocumentDeleted(ServiceEvent):
    """An uploaded task tree, scene or scenario was deleted; journaled as it is."""

    type: Literal["document_deleted"] = "document_deleted"
    kind: Literal["tree", "scene", "scenario"]
    name: str
    author: Author | None


class ModelKept(ServiceEvent):
    """A robot's model was uploaded; `version` is another one for other files."""

    type: Literal["model_kept"] = "model_kept"
    name: str
    version: str
    replaced: bool
    author: Author | None


class ModelDeleted(ServiceEvent):
    """An uploaded model was deleted."""

    type: Literal["model_deleted"] = "model_deleted"
    name: str
    author: Author | None


class AddressCount(EventModel):
    """How often something came from an address."""

    address: str
    times: int


class SignedIn(ServiceEvent):
    """A principal signed in, `times` since the last such event; `elsewhere`: at more addresses."""

    type: Literal["signed_in"] = "signed_in"
    principal: str
    role: Role
    times: int
    addresses: list[AddressCount]
    elsewhere: int = 0


class SignInFailed(ServiceEvent):
    """Wrong tokens and codes were shown, `times` since the event before, by whomever."""

    type: Literal["sign_in_failed"] = "sign_in_failed"
    times: int
    addresses: list[AddressCount]
    elsewhere: int = 0


class SignedOut(ServiceEvent):
    """A session was ended; its cookie, good until `expires`, opens nothing any more."""

    type: Literal["signed_out"] = "signed_out"
    session: str
    expires: int
    author: Author


class AccessChanged(ServiceEvent):
    """Somebody was given access, or it was taken from them.

    `change` is the id that the file of principals gives it. `address` of the author is None for
    what was done on the service's machine.
    """

    type: Literal["access_changed"] = "access_changed"
    what: Literal["added", "rotated", "revoked", "enrolment_opened", "enrolled"]
    principal: str
    role: Role
    author: Author
    change: UUID | None = None


class PushSubscribed(ServiceEvent):
    """A helper wants a device to be called; where that is done is a secret, and not told here."""

    type: Literal["push_subscribed"] = "push_subscribed"
    helper: str
    device: str
    author: Author


class PushEnded(ServiceEvent):
    """A device is called no more: its helper `asked` for that, or it cannot be.

    `gone`: its push service knows it no more; `revoked`: the credential that it was subscribed
    with is good no more; `key_changed`: the service has another push key.
    """

    type: Literal["push_ended"] = "push_ended"
    helper: str
    device: str
    why: Literal["asked", "gone", "revoked", "key_changed"]
    author: Author | None = None
