"""Principals, and what they did, as clients are told."""

from pydantic import AwareDatetime

from mend.server.access.deeds import Deed
from mend.server.access.roles import Role
from mend.server.runtime.views import View


class PrincipalView(View):
    """A principal; `valid` is false once its token has expired."""

    name: str
    role: Role
    added: AwareDatetime
    expires: AwareDatetime | None
    valid: bool


class TokenView(View):
    """A new token, which is shown only this once."""

    name: str
    token: str


class CodeView(View):
    """A one-time code, which is shown only this once."""

    robot: str
    code: str


class DeedsPage(View):
    """Deeds in order. `seq`: up to which event was read; `more`: whether events follow it."""

    deeds: list[Deed]
    seq: int
    more: bool
