"""Whatever is sent to the REST API: no 5xx, and only what the OpenAPI says."""

from collections.abc import Iterator

import pytest
import schemathesis
from hypothesis import HealthCheck, given, settings
from hypothesis.strategies import one_of
from schemathesis import GenerationMode
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)
from service_under_test import ServiceUnderTest, build

CHECKS = [
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_schema_conformance,
]


@pytest.fixture
def service() -> Iterator[ServiceUnderTest]:
    service = build(allowed_hosts=["testserver"])
    yield service
    service.journal.close()


@pytest.mark.slow
def test_every_operation_answers_as_it_is_documented(service: ServiceUnderTest) -> None:
    schema = schemathesis.openapi.from_asgi("/openapi.json", service.app)
    operations = [result.ok() for result in schema.get_all_operations()]
    assert len(operations) > 40
    for operation in operations:
        # What its parameters and body may be, and what they may not be.
        sent = one_of(operation.as_strategy(mode) for mode in GenerationMode)

        @settings(max_examples=8, suppress_health_check=list(HealthCheck))
        @given(case=sent)
        def answers_as_documented(case: schemathesis.Case) -> None:
            case.call_and_validate(checks=CHECKS)

        answers_as_documented()
