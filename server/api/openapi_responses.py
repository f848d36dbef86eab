"""The answers that any operation may give, for the OpenAPI: of the gate and of the journal."""

from typing import Any

from mend.server.access.permissions import ENDPOINTS
from mend.server.api.problems import documented

ANYWHERE = (413, 421, 429, 500, 503)
"""A body that is too large, an unknown Host; who has to wait; what cannot be read or written now.

A door that is open to everybody answers 429 to whoever shows something there all the same.
"""

WITH_ROLE = (401, 403)
"""Nobody who is known, or somebody who may not do that."""


def document_answers(schema: dict[str, Any]) -> None:
    """Add to each operation the refusals that it need not name itself."""
    open_doors = {each.operation for each in ENDPOINTS if each.role is None}
    for path in schema["paths"].values():
        for operation in path.values():
            is_open = operation["operationId"] in open_doors
            more = documented(*ANYWHERE, *(() if is_open else WITH_ROLE))
            answers = operation["responses"]
            for status, answer in more.items():
                answers.setdefault(str(status), answer)
            operation["responses"] = dict(sorted(answers.items()))
