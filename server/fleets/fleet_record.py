"""What the journal keeps of a site's fleet, from which it goes on after a restart."""

from mend.documents.strict_model import StrictModel
from mend.fleet.dispatch.snapshot import DispatcherSnapshot


class FleetRecord(StrictModel):
    """A fleet at work; `out_of_service`: the robots that somebody has taken out, and why."""

    dispatcher: DispatcherSnapshot
    out_of_service: dict[str, str]
