"""A device that is to be called, as the journal keeps it."""

import hashlib
from datetime import datetime

from pydantic import BaseModel, ConfigDict

KIND = "push_subscription"
"""The kind of document that the journal keeps it as; its name is the subscription's id."""

ID_CHARS = 32


class DeviceKeys(BaseModel):
    """What is encrypted with for a device, both in base64url."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    p256dh: str
    auth: str


class PushSubscription(BaseModel):
    """Where a helper's device is called.

    `endpoint` and `keys` are secrets: whoever has them can push to the device. `key` is the
    credential of the `principal` that it belongs to, and ends with; `application_key` is the public
    half of this service's own that the device expects pushes of.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    id: str
    helper: str
    principal: str
    key: str
    device: str
    since: datetime
    endpoint: str
    keys: DeviceKeys
    application_key: str


def id_of(endpoint: str) -> str:
    """The id of a subscription: a browser that asks again has the one that it had."""
    return hashlib.sha256(endpoint.encode()).hexdigest()[:ID_CHARS]
