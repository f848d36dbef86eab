"""Reverse proxies whose word is taken for where a request comes from."""

import ipaddress
from collections.abc import Sequence
from typing import Annotated

from pydantic import AfterValidator

MAPPED_BITS = 96
"""IPv4 addresses on an IPv6 socket are the last 32 bits of `::ffff:0:0/96`."""


def _require_network(text: str) -> str:
    try:
        return str(ipaddress.ip_network(text, strict=False))
    except ValueError:
        raise ValueError(
            f"{text!r} is neither an IP address nor a network; right are 10.0.0.5 and 10.0.0.0/24"
        ) from None


ProxyNetwork = Annotated[str, AfterValidator(_require_network)]


class TrustedProxies:
    """The addresses of the proxies in some networks."""

    def __init__(self, networks: Sequence[str]) -> None:
        self._networks = [ipaddress.ip_network(each) for each in networks]

    def __contains__(self, address: object) -> bool:
        """Whether an address is one of theirs, also as IPv4 mapped to IPv6."""
        try:
            found = ipaddress.ip_address(str(address))
        except ValueError:
            return False
        if isinstance(found, ipaddress.IPv6Address) and found.ipv4_mapped is not None:
            found = found.ipv4_mapped
        return any(found in network for network in self._networks)

    def __bool__(self) -> bool:
        return bool(self._networks)

    @property
    def as_written(self) -> list[str]:
        """The networks, each of IPv4 also as it looks on an IPv6 socket."""
        written = [str(each) for each in self._networks]
        written += [
            f"::ffff:{each.network_address}/{MAPPED_BITS + each.prefixlen}"
            for each in self._networks
            if isinstance(each, ipaddress.IPv4Network)
        ]
        return written
