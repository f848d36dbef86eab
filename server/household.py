"""Whose an address is, as far as limits by address go."""

import ipaddress

IPV6_PREFIX = 64
"""The least that a provider gives to one customer, who may use every address of it."""


def household_of(address: str | None) -> str:
    """The address itself; of IPv6 the network that one customer has.

    What is no IP address stands for itself; nothing for where there is no address.
    """
    if address is None:
        return ""
    try:
        found = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if isinstance(found, ipaddress.IPv4Address):
        return str(found)
    if found.ipv4_mapped is not None:
        return str(found.ipv4_mapped)
    return str(ipaddress.ip_network((found, IPV6_PREFIX), strict=False))
