"""Where a client says under which key it sends something."""

HEADER = "Idempotency-Key"
