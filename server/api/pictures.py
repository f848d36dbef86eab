"""The pictures in which faults were seen."""

from uuid import UUID

from fastapi import APIRouter, Response

from mend.errors import NotFoundError
from mend.server.api.problems import documented
from mend.server.api.services import WithServices

router = APIRouter(prefix="/api/pictures", tags=["pictures"])


@router.get(
    "/{picture}",
    operation_id="get_picture",
    response_class=Response,
    responses={
        200: {"content": {"image/jpeg": {}}, "description": "The picture."},
        **documented(401, 404, 421, 422),
    },
)
async def get_picture(picture: UUID, services: WithServices) -> Response:
    """The picture that an event names."""
    jpeg = await services.journal.picture(picture)
    if jpeg is None:
        raise NotFoundError(f"there is no picture {picture}")
    headers = {"Cache-Control": "private, max-age=31536000, immutable"}
    return Response(jpeg, media_type="image/jpeg", headers=headers)
