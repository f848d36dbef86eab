"""Whatever is sent to the REST API: no 5xx, and only what the OpenAPI says."""

from collections.abc import Iterator

import pytest
import schemathesis
from hypothesis import HealthCheck, settings
from plain_problems import told_plainly
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)
from service_under_test import build

SERVICE = build(allowed_hosts=["testserver"])
SCHEMA = schemathesis.openapi.from_asgi("/openapi.json", SERVICE.app)


@pytest.fixture(autouse=True, scope="session")
def _close() -> Iterator[None]:
    """At the very end: a worker may come back to this file after others."""
    yield
    SERVICE.journal.close()


@pytest.mark.slow
@SCHEMA.parametrize()
@settings(max_examples=10, deadline=None, suppress_health_check=list(HealthCheck))
def test_rest(case: schemathesis.Case) -> None:
    case.call_and_validate(
        checks=[
            not_a_server_error,
            status_code_conformance,
            content_type_conformance,
            response_schema_conformance,
            told_plainly,
        ]
    )
