"""Whatever is sent to the REST API: no 5xx, and only what the OpenAPI says."""

from collections import Counter, defaultdict
from math import inf

import pytest
import schemathesis
from hypothesis import HealthCheck, settings
from plain_problems import told_plainly
from sampled import sample
from schemathesis.checks import not_a_server_error
from schemathesis.pytest.lazy import get_all_tests
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)
from service_under_test import TOKEN, build

from mend.server.limits import Limits

SETTINGS = settings(
    max_examples=sample(1, 10), deadline=None, suppress_health_check=list(HealthCheck)
)

ALL_OF = sample(10.0, inf)
"""Of so many cases that are drawn for an operation all are sent, and of more every eighth."""

CHECKS = [
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_schema_conformance,
    told_plainly,
]
SIGNED_IN = {"Authorization": f"Bearer {TOKEN}"}
"""Who is not is let in only until there are principals, which some requests add."""
REFUSED = {401, 405}


@pytest.mark.slow(10)
def test_rest(subtests: pytest.Subtests) -> None:
    """Each operation in turn.

    With `parametrize`, each process that collects the tests would draw all requests.
    """
    limits = Limits(wrong_tokens=2**31 - 1)
    service = build(allowed_hosts=["testserver"], token=TOKEN, limits=limits)
    answered: dict[str, set[int]] = defaultdict(set)
    drawn = Counter[str]()

    def check(case: schemathesis.Case) -> None:
        number = drawn[case.operation.label]
        drawn[case.operation.label] += 1
        if number >= ALL_OF and number % 8:
            return
        answer = case.call_and_validate(headers=SIGNED_IN, checks=CHECKS)
        answered[case.operation.label].add(answer.status_code)

    schema = schemathesis.openapi.from_asgi("/openapi.json", service.app)
    tests = [
        each.ok()
        for each in get_all_tests(
            schema=schema, test_func=check, settings=SETTINGS, given_kwargs={}
        )
    ]
    assert {operation.label for operation, _ in tests} == {
        f"{method.upper()} {path}"
        for path, methods in schema.raw_schema["paths"].items()
        for method in methods
    }
    for operation, test in tests:
        with subtests.test(operation.label):
            test()
    assert [each for each, codes in answered.items() if codes <= REFUSED] == []
    service.journal.close()
