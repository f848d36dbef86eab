"""Which addresses belong to trusted proxies."""

import pytest

from mend.server.proxies import TrustedProxies


@pytest.mark.parametrize(
    ("address", "trusted"),
    [
        ("10.0.0.1", True),
        ("::ffff:10.0.0.1", True),
        ("10.0.1.1", False),
        ("::ffff:10.0.1.1", False),
        ("192.168.1.5", True),
        ("2001:db8::7", True),
        ("2001:db8:1::7", False),
        ("localhost", False),
        ("", False),
    ],
)
def test_an_address_of_a_network_is_trusted_in_every_form(address: str, trusted: bool) -> None:
    proxies = TrustedProxies(["10.0.0.0/24", "192.168.1.5/32", "2001:db8::/48"])
    assert (address in proxies) is trusted


def test_nobody_is_trusted_by_default() -> None:
    assert not TrustedProxies([])
    assert "127.0.0.1" not in TrustedProxies([])


def test_networks_of_ipv4_are_written_as_ipv6_sockets_see_them_too() -> None:
    proxies = TrustedProxies(["10.0.0.0/24", "2001:db8::/48"])
    assert proxies.as_written == ["10.0.0.0/24", "2001:db8::/48", "::ffff:10.0.0.0/120"]
