"""Deeds: what people did, when and from where, as the audit lists it."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from uuid import UUID

from pydantic import BaseModel, ConfigDict

from mend.server.access.principal import SCRIPT
from mend.server.access.roles import Role, with_article
from mend.server.journal import events as ev
from mend.server.journal.chain import Seal
from mend.server.journal.journal import UnreadableEvent
from mend.server.journal.reader import JournalReader
from mend.server.steering_words import because, told_level, told_word


class Deed(BaseModel):
    """One deed. `who` None: nobody who is known; `seq` is its event, `run` None: of no run.

    `when` is None where the event cannot be read; `deed` is then `unreadable`, and `what` says why.
    `digest` and `link` are what the journal's chain has of its batch, in hex, as they were
    written. `damaged` says why it may not be what was committed; None where the chain holds.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    seq: int
    when: datetime | None
    who: str | None
    role: Role | None
    address: str | None
    deed: str
    what: str
    run: UUID | None
    digest: str | None = None
    link: str | None = None
    damaged: str | None = None

    def sealed(self, seal: Seal | None) -> "Deed":
        """With what the chain says of its event; as it is where there is no chain."""
        if seal is None:
            return self
        return self.model_copy(
            update={"digest": _hex(seal.digest), "link": _hex(seal.link), "damaged": seal.wrong}
        )


def _hex(digest: bytes | None) -> str | None:
    return None if digest is None else digest.hex()


@dataclass(frozen=True, slots=True)
class Audit:
    """Every deed in a journal, in order, and a sentence for each place where it is damaged."""

    deeds: Sequence[Deed]
    damage: Sequence[str]


DEEDS: frozenset[str] = frozenset(
    {
        "run_started", "run_paused", "run_resumed", "run_aborted", "intervention_accepted",
        "recording_begun", "answered", "claimed", "released", "deadline_extended", "help_reported",
        "promise_taken_back",
        "document_kept", "document_deleted", "model_kept", "model_deleted",
        "signed_in", "sign_in_failed", "signed_out",
        "access_changed", "site_opened", "site_closed", "node_taken", "request_changed",
        "fleet_told", "errand_begun", "push_subscribed", "push_ended",
        "autonomy_set", "breakpoint_set", "breakpoint_removed", "leaf_let_go", "leaf_preferred",
        "leaf_not_preferred", "leaf_tried_again", "node_left_out",
    }
)  # fmt: skip
"""The types of events that are deeds; some of them only where somebody did them."""

UNREADABLE = "unreadable"
"""In the place of a type: the event cannot be read."""


def audit_of(journal: Path) -> Audit:
    """The audit of a journal's file, which may be in use, with a look at its whole chain.

    Raises `FileNotFoundError`, `JournalSchemaError` and `JournalReadError`.
    """
    with JournalReader(journal, marks=True) as reader, reader.at_one_moment():
        seals = reader.seals()
        deeds = [
            deed.sealed(None if seals is None else seals.of(deed.seq))
            for deed in map(deed_of, reader.of_types(sorted(DEEDS)))
            if deed is not None
        ]
        return Audit(deeds, reader.damage())


def deed_of(event: ev.Event | UnreadableEvent) -> Deed | None:
    """The deed that an event tells of; None for what no person did.

    What cannot be read may have been one.
    """
    match event:
        case UnreadableEvent(seq=seq, why=why, run=run):
            return Deed(
                seq=seq, when=None, who=None, role=None, address=None, deed=UNREADABLE, what=why,
                run=run,
            )  # fmt: skip
        case ev.SignedIn():
            signed = f"signed in {_times(event.times)}{_from(event.addresses, event.elsewhere)}"
            return _deed(event, event.principal, event.role, _only(event), signed)
        case ev.SignInFailed():
            showed = f"showed wrong tokens {_times(event.times)}"
            showed += _from(event.addresses, event.elsewhere)
            return _deed(event, None, None, _only(event), showed)
        case ev.Released(expired=True):
            return None
    what = _what(event)
    if what is None:
        return None
    author: ev.Author | None = getattr(event, "author", None)
    if author is None:
        helper = getattr(event, "helper", None)
        return None if helper == SCRIPT else _deed(event, helper, None, None, what)
    return _deed(event, author.principal, author.role, author.address, what)


def _deed(
    event: ev.Event, who: str | None, role: Role | None, address: str | None, what: str
) -> Deed:
    return Deed(
        seq=event.seq,
        when=event.wall_time,
        who=who,
        role=role,
        address=address,
        deed=str(vars(event)["type"]),
        what=what,
        run=None if event.run == ev.NO_RUN else event.run,
    )


_ASKED = {
    "cancelled": "no longer wanted",
    "returning": "no longer wanted",
    "refused": "asked in vain for",
}
"""What somebody did with a request, by how it stood then."""


def _what(event: ev.Event) -> str | None:
    match event:
        case ev.RunStarted(tree_name=tree, world=world):
            return f"started a run of '{tree}' in '{world}'"
        case ev.SiteOpened(scene=scene, world=world):
            return f"opened a site with '{scene}' in '{world}'"
        case ev.SiteClosed(site=site):
            return f"closed the site {site}"
        case ev.FleetTold(told=told, finder=None):
            return told
        case ev.ErrandBegun(author=ev.Author(), robot=robot, place=place):
            return f"sent {robot} to {place}"
        case ev.RequestChanged(author=ev.Author(), request=request, status=status):
            return f"{_ASKED.get(status, 'asked for')} '{request}'"
        case ev.RunPaused():
            return "paused the run"
        case ev.RunResumed():
            return "let the run go on"
        case ev.RunAborted(reason=reason):
            return "aborted the run" + (f": {reason}" if reason else "")
        case ev.InterventionAccepted(act=act, object=part):
            return f"intervened: {act}" + (f" '{part}'" if part else "")
        case ev.RecordingBegun(seconds=seconds):
            return f"had the cameras recorded for {seconds:g} s"
        case ev.NodeTaken(name=name, helper=helper):
            return f"took '{name}' as '{helper}', to do it"
        case ev.SteeringEvent():
            return f"steered: {told_word(event)}"
        case ev.AutonomySet():
            return f"steered: {told_level(event)}"
        case ev.NodeLeftOut(robot=None, name=name, reason=reason):
            return f"steered: leaves {name} out{because(reason)}"
        case ev.SignedOut():
            return "signed out"
    return _what_of_dialogue(event) or _what_of_access(event) or _what_of_push(event)


def _what_of_dialogue(event: ev.Event) -> str | None:
    match event:
        case ev.Answered(answer=answer, issue=issue, name=name, helper=helper):
            return f"answered {answer} as '{helper}' ({issue}, '{name}')"
        case ev.Claimed(issue=issue, name=name, helper=helper):
            return f"claimed the dialogue as '{helper}' ({issue}, '{name}')"
        case ev.Released(issue=issue, name=name, helper=helper):
            return f"released the claim of '{helper}' ({issue}, '{name}')"
        case ev.DeadlineExtended(issue=issue, name=name, helper=helper):
            return f"took more time as '{helper}' ({issue}, '{name}')"
        case ev.HelpReported(issue=issue, name=name, helper=helper):
            return f"said as '{helper}' that the help is done ({issue}, '{name}')"
        case ev.PromiseTakenBack(issue=issue, name=name, helper=helper):
            return f"took back the promise of '{helper}' ({issue}, '{name}')"
    return None


def _what_of_push(event: ev.Event) -> str | None:
    match event:
        case ev.PushSubscribed(helper=helper, device=device):
            return f"wants '{device}' to be called as '{helper}'"
        case ev.PushEnded(author=ev.Author(), helper=helper, device=device):
            return f"wants '{device}' to be called as '{helper}' no more"
    return None


def _what_of_access(event: ev.Event) -> str | None:
    match event:
        case ev.DocumentKept(kind=kind, name=name, replaced=replaced):
            return f"{'replaced' if replaced else 'uploaded'} the {kind} '{name}'"
        case ev.DocumentDeleted(kind=kind, name=name):
            return f"deleted the {kind} '{name}'"
        case ev.ModelKept(name=name, replaced=replaced):
            return f"{'replaced' if replaced else 'uploaded'} the robot model '{name}'"
        case ev.ModelDeleted(name=name):
            return f"deleted the robot model '{name}'"
        case ev.AccessChanged(what="added", principal=name, role=role):
            return f"added '{name}' as {with_article(role)}"
        case ev.AccessChanged(what="rotated", principal=name):
            return f"gave '{name}' a new token"
        case ev.AccessChanged(what="revoked", principal=name):
            return f"revoked '{name}'"
        case ev.AccessChanged(what="enrolment_opened", principal=name):
            return f"made a code for the robot '{name}'"
        case ev.AccessChanged(principal=name):
            return f"enrolled as the robot '{name}'"
    return None


def _only(event: ev.SignedIn | ev.SignInFailed) -> str | None:
    """The address, where there is only one."""
    only = len(event.addresses) == 1 and event.elsewhere == 0
    return event.addresses[0].address if only else None


def _times(times: int) -> str:
    return "once" if times == 1 else f"{times} times"


def _from(addresses: Sequence[ev.AddressCount], elsewhere: int) -> str:
    if len(addresses) <= 1 and elsewhere == 0:
        return ""
    listed = ", ".join(f"{each.address} ({each.times})" for each in addresses)
    return f", from {listed}" + (f" and elsewhere ({elsewhere})" if elsewhere else "")
