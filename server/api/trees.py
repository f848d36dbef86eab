"""Task trees and scenarios over REST."""

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from pydantic import BaseModel, ConfigDict, ValidationError
from starlette.concurrency import run_in_threadpool

from server.api.parts import Limit, Offset, TreeName, WithParts
from server.api.problems import ProblemError, documented, validation_sentences
from server.errors import InvalidError
from server.trees import TreeCheck, TreeSummary, TreeView
from tasks.scenario import Scenario
from tasks.scene import Name

router = APIRouter(prefix="/api", tags=["trees"])

YAML_TYPES = ("application/yaml", "application/x-yaml", "text/yaml", "text/x-yaml")

EXAMPLE = """\
name: two_boxes
tree:
  then:
    - {behavior: pick_and_place, object: red_box, place: left}
    - {behavior: pick_and_place, object: blue_box, place: right}
"""


class TreeUpload(BaseModel):
    """A task file as YAML or JSON text; `name` wins over the one in the file."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    name: Name | None = None
    text: str


UPLOAD_BODY: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {
            "application/json": {
                "schema": TreeUpload.model_json_schema(),
                "example": {"name": "two_boxes", "text": EXAMPLE},
            },
            "application/yaml": {"schema": {"type": "string"}, "example": EXAMPLE},
        },
    }
}


@router.get("/trees", operation_id="list_trees", responses=documented(401, 421, 422))
async def list_trees(
    parts: WithParts, limit: Limit = 1000, offset: Offset = 0
) -> list[TreeSummary]:
    """Every task tree that a run may name."""
    return (await parts.trees.trees())[offset : offset + limit]


@router.post(
    "/trees",
    operation_id="upload_tree",
    status_code=201,
    response_model=TreeView,
    responses={
        200: {"model": TreeView, "description": "An uploaded tree of this name was replaced."},
        **documented(400, 401, 403, 409, 413, 415, 421, 422),
    },
    openapi_extra=UPLOAD_BODY,
)
async def upload_tree(
    request: Request,
    response: Response,
    parts: WithParts,
    name: Annotated[Name | None, Query(description="For a YAML body: the tree's name.")] = None,
) -> TreeView:
    """Check a task file and keep it."""
    upload = await _read_upload(request, name)
    tree, new = await parts.trees.save(upload.name, upload.text)
    response.status_code = 201 if new else 200
    response.headers["Location"] = f"/api/trees/{tree.name}"
    return tree


@router.post(
    "/trees/check",
    operation_id="check_tree",
    response_model=TreeCheck,
    responses=documented(400, 401, 403, 413, 415, 421, 422),
    openapi_extra=UPLOAD_BODY,
)
async def check_tree(request: Request, parts: WithParts) -> TreeCheck:
    """Check a task file without keeping it: its definition, or every mistake with its line."""
    upload = await _read_upload(request, None)
    checked = await run_in_threadpool(parts.trees.check, upload.text)
    return checked if upload.name is None else checked.model_copy(update={"name": upload.name})


@router.get("/trees/{name}", operation_id="get_tree", responses=documented(401, 404, 421, 422))
async def get_tree(name: TreeName, parts: WithParts) -> TreeView:
    """One task tree with its file's text."""
    return await parts.trees.tree(name)


@router.delete(
    "/trees/{name}",
    operation_id="delete_tree",
    status_code=204,
    responses=documented(401, 403, 404, 409, 421, 422),
)
async def delete_tree(name: TreeName, parts: WithParts) -> None:
    """Delete an uploaded task tree; runs that were started with it go on."""
    await parts.trees.delete(name)


@router.get("/scenarios", operation_id="list_scenarios", responses=documented(401, 421, 422))
async def list_scenarios(
    parts: WithParts, limit: Limit = 1000, offset: Offset = 0
) -> list[Scenario]:
    """The scenarios that a run may name."""
    return parts.scenarios.scenarios()[offset : offset + limit]


async def _read_upload(request: Request, name: str | None) -> TreeUpload:
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    body = await request.body()
    if kind in YAML_TYPES:
        return TreeUpload(name=name, text=_decode(body))
    if kind != "application/json":
        raise ProblemError(
            415, "send the tree as application/json with a 'text', or as application/yaml"
        )
    try:
        upload = TreeUpload.model_validate_json(body)
    except ValidationError as error:
        sentences = validation_sentences(error.errors())
        raise InvalidError("the upload cannot be used", sentences) from None
    return upload if name is None else upload.model_copy(update={"name": name})


def _decode(body: bytes) -> str:
    try:
        return body.decode("utf-8")
    except UnicodeDecodeError as error:
        raise ProblemError(400, f"the body is not UTF-8: byte {error.start} is wrong") from None
