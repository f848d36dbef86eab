"""Events of a site."""

from typing import Any, Literal
from uuid import UUID

from mend.server.journal.events.event import Author, ServiceEvent
from mend.tasks.intervention import Intervention


class SiteEvent(ServiceEvent):
    """An event of a site, which runs use or not."""

    site: UUID


class SiteOpened(SiteEvent):
    """A simulated world was started, with these robots, to be there until it is closed."""

    type: Literal["site_opened"] = "site_opened"
    world: str
    scene: str
    robots: list[str]
    seed: int
    speed: float | Literal["max"]
    options: dict[str, Any]
    author: Author | None = None


class SiteGivenBack(SiteEvent):
    """A run has ended, and its robots are the site's again.

    `moved`: what it left at which place.
    """

    type: Literal["site_given_back"] = "site_given_back"
    of_run: UUID
    robots: list[str]
    moved: dict[str, str]


class SiteRestarted(SiteEvent):
    """A site's world had ended, and is started again where the journal has it."""

    type: Literal["site_restarted"] = "site_restarted"
    reason: str


class SiteIntervention(SiteEvent):
    """A person did something in a site's world, told by a robot that no run had.

    `at_s` is of the site's clock; `by` says who (scenario, helper, api, ...).
    """

    type: Literal["site_intervention"] = "site_intervention"
    at_s: float
    intervention: Intervention
    by: str
    ok: bool = True
    detail: str = ""


class SiteClosed(SiteEvent):
    """A site's world was stopped for good."""

    type: Literal["site_closed"] = "site_closed"
    author: Author | None = None
