"""TLS to a service whose certificate is at hand, as it is on the service's own machine."""

import ssl
from pathlib import Path

END = "-----END CERTIFICATE-----"


def pinned_tls(certificate: Path) -> ssl.SSLContext:
    """Trusts the holder of this very certificate, whatever it is named and whoever issued it.

    Of several certificates in the file the first counts. Raises `OSError` if it cannot be read.
    """
    first, end, _ = certificate.read_text("ascii", errors="replace").partition(END)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    # The service is reached by the address that it listens on, which is seldom in its certificate.
    context.check_hostname = False
    context.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN
    context.load_verify_locations(cadata=first + end)
    return context
