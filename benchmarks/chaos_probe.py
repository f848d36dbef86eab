"""Asks for `/healthz` all the time, in a thread of its own, and notes how long that took."""

import http.client
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from http import HTTPStatus

EVERY_S = 0.1
PATIENCE_S = 10.0


class Probe:
    """`latencies_s` of what was answered with 200, `failures` while all should have been."""

    def __init__(self, port: int, token: str) -> None:
        self.latencies_s: list[float] = []
        self.failures = 0
        self._port = port
        self._headers = {"Authorization": f"Bearer {token}"}
        self._not_expected = 0
        self._epoch = 0
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._ask_on, name="probe", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        """Whether it was started or not."""
        self._stop.set()
        if self._thread.ident is not None:
            self._thread.join()

    @contextmanager
    def excused(self) -> Iterator[None]:
        """Reaction nobody expects an answer: the service is stopped, or is not there."""
        self._not_expected += 1
        self._epoch += 1
        try:
            yield
        finally:
            self._epoch += 1
            self._not_expected -= 1

    def _ask_on(self) -> None:
        connection = http.client.HTTPConnection("127.0.0.1", self._port, timeout=PATIENCE_S)
        while not self._stop.wait(EVERY_S):
            epoch, began = self._epoch, time.perf_counter()
            answered = is_healthy(connection, self._headers)
            if self._not_expected or epoch != self._epoch:
                continue
            if answered:
                self.latencies_s.append(time.perf_counter() - began)
            else:
                self.failures += 1
        connection.close()


def is_healthy(connection: http.client.HTTPConnection, headers: Mapping[str, str]) -> bool:
    """Ask for `/healthz`; whether it is answered, which a refusal, however fast, is not."""
    try:
        # It connects by itself where there is no connection any more.
        connection.request("GET", "/healthz", headers=dict(headers))
        answer = connection.getresponse()
        answer.read()
    except (OSError, http.client.HTTPException):
        connection.close()
        return False
    return answer.status == HTTPStatus.OK
