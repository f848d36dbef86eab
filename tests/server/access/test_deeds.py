"""The audit tells deeds in sentences, and what nobody did is none."""

from datetime import UTC, datetime
from uuid import uuid4

from mend.server.access.deeds import DEEDS, deed_of
from mend.server.access.roles import Role
from mend.server.journal import events as ev

NOW = datetime(2026, 5, 4, 12, tzinfo=UTC)
OLGA = ev.Author(principal="olga", role=Role.OPERATOR, address="10.0.0.7")


def run() -> dict[str, object]:
    return {"time": 1.0, "wall_time": NOW, "run": uuid4()}


def test_a_deed_says_who_from_where_and_what() -> None:
    deed = deed_of(ev.RunAborted.model_validate({**run(), "author": OLGA}))
    assert deed is not None
    assert (deed.who, deed.role, deed.address) == ("olga", Role.OPERATOR, "10.0.0.7")
    assert (deed.deed, deed.what) == ("run_aborted", "aborted the run")


def test_what_belongs_to_no_run_says_so() -> None:
    kept = ev.DocumentKept(wall_time=NOW, kind="tree", name="two", replaced=True, author=OLGA)
    deed = deed_of(kept)
    assert deed is not None
    assert (deed.run, deed.what) == (None, "replaced the tree 'two'")


def test_failed_sign_ins_say_from_where_they_came() -> None:
    counts = [ev.AddressCount(address=each, times=2) for each in ("10.0.0.1", "10.0.0.2")]
    event = ev.SignInFailed(wall_time=NOW, times=5, addresses=counts, elsewhere=1)
    deed = deed_of(event)
    assert deed is not None
    assert deed.what == (
        "showed wrong tokens 5 times, from 10.0.0.1 (2), 10.0.0.2 (2) and elsewhere (1)"
    )


def test_a_script_and_a_lease_that_ran_out_do_nothing() -> None:
    talk = {**run(), "node": "/0", "name": "bar", "dialogue": uuid4(), "robot": "r"}
    talk |= {"issue": "dropped", "object": None}
    scripted = {**talk, "prompt": uuid4(), "version": 1, "answer": "yes", "helper": "script"}
    assert deed_of(ev.Answered.model_validate(scripted)) is None
    assert deed_of(ev.Answered.model_validate({**scripted, "helper": "anna"})) is not None
    expired = {**talk, "helper": "anna", "expired": True}
    assert deed_of(ev.Released.model_validate(expired)) is None


def test_every_event_that_names_an_author_is_a_deed() -> None:
    union = ev.AnyEvent.__origin__  # type: ignore[attr-defined]
    named = {
        each.model_fields["type"].default
        for each in union.__args__
        if "author" in each.model_fields
    }
    assert named <= DEEDS
