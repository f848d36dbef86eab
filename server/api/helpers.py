"""Who helps at this moment, over REST."""

from fastapi import APIRouter

from mend.server.api.problems import documented
from mend.server.api.services import WithServices
from mend.server.dialogues.who_helps import HelpersView

router = APIRouter(prefix="/api/helpers", tags=["dialogues"])


@router.get("", operation_id="list_helpers", responses=documented(401, 421))
async def list_helpers(services: WithServices) -> HelpersView:
    """Who may be asked, and who of them is here, away, called by push alone, or busy."""
    return services.runs.helpers()
