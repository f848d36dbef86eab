"""What every answer tells browsers, so that nothing of it is misused."""

SAFE_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    # An answer that is no page may do nothing, wherever it is opened. Pages have their own.
    "Content-Security-Policy": "default-src 'none'; base-uri 'none'; frame-ancestors 'none'",
}

OVER_TLS = {"Strict-Transport-Security": "max-age=31536000"}
"""A year in which a browser that has come over TLS comes in no other way."""
