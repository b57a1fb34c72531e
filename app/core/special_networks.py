"""Which addresses belong to the public network: what IANA's registries reserve for something else does not.

The registries (last read in November 2026):
    https://www.iana.org/assignments/iana-ipv4-special-registry
    https://www.iana.org/assignments/iana-ipv6-special-registry
    https://www.iana.org/assignments/multicast-addresses
    https://www.iana.org/assignments/ipv6-unicast-address-assignments
A table of our own: `ipaddress` knows what its Python knew (3.11 takes 5f00::/16 and 192.0.0.8 for global), and asks
where packets may go, while here nothing is lost by refusing whole blocks in which no server of anybody's stands.
"""

from collections.abc import Iterable
from ipaddress import IPv4Address, IPv4Network, IPv6Address, IPv6Network, ip_address
from typing import Final

Network = IPv4Network | IPv6Network

SPECIAL_IPV4: Final = tuple(
    map(
        IPv4Network,
        (
            "0.0.0.0/8",  # this network, RFC 791
            "10.0.0.0/8",  # private, RFC 1918
            "100.64.0.0/10",  # shared by carriers, RFC 6598
            "127.0.0.0/8",  # loopback, RFC 1122
            "169.254.0.0/16",  # link local, RFC 3927; where clouds keep a machine's credentials
            "172.16.0.0/12",  # private, RFC 1918
            "192.0.0.0/24",  # IETF protocols, RFC 6890: DS-Lite, NAT64 discovery, dummy, anycasts
            "192.0.2.0/24",  # documentation, RFC 5737
            "192.31.196.0/24",  # AS112, RFC 7535
            "192.52.193.0/24",  # AMT, RFC 7450
            "192.88.99.0/24",  # 6to4 relays, given up, RFC 7526
            "192.168.0.0/16",  # private, RFC 1918
            "192.175.48.0/24",  # AS112, RFC 7534
            "198.18.0.0/15",  # benchmarks, RFC 2544
            "198.51.100.0/24",  # documentation, RFC 5737
            "203.0.113.0/24",  # documentation, RFC 5737
            "224.0.0.0/4",  # multicast, RFC 5771
            "240.0.0.0/4",  # reserved and broadcast, RFC 1112
        ),
    )
)
GLOBAL_UNICAST: Final = IPv6Network("2000::/3")
"""All that IANA has given out of IPv6. Outside of it are, among others: IPv4-compatible addresses (::/96),
64:ff9b:1::/48, 100::/64, segment routing (5f00::/16), fc00::/7, fe80::/10, site local (fec0::/10), multicast."""
SPECIAL_IPV6: Final = tuple(
    map(
        IPv6Network,
        (
            "2001::/23",  # IETF protocols, RFC 2928: Teredo, benchmarks, AMT, ORCHID, drones
            "2001:db8::/32",  # documentation, RFC 3849
            "2002::/16",  # 6to4, given up, RFC 7526: it carries packets to any IPv4 address
            "2620:4f:8000::/48",  # AS112, RFC 7534
            "3ffe::/16",  # 6bone, given back, RFC 3701
            "3fff::/20",  # documentation, RFC 9637
        ),
    )
)
TRANSLATED: Final = (IPv6Network("::ffff:0:0/96"), IPv6Network("64:ff9b::/96"))
"""Mapped (RFC 4291) and NAT64's well-known prefix (RFC 6052): packets end up at the IPv4 address in the last bits."""


def is_public(address: str, refused: Iterable[Network] = ()) -> bool:
    """Tell if an address belongs to the public network, and to none of the `refused` ones, through a translator too.

    With a zone (`%eth0`) it names a way out of this machine, and no public address needs one.
    """
    if "%" in address:
        return False
    ip = ip_address(address)
    ends_up_at = _translated(ip) or ip
    return _is_global(ends_up_at) and not any(one in network for network in refused for one in (ip, ends_up_at))


def _translated(ip: IPv4Address | IPv6Address) -> IPv4Address | None:
    return IPv4Address(int(ip) & 0xFFFFFFFF) if any(ip in network for network in TRANSLATED) else None


def _is_global(ip: IPv4Address | IPv6Address) -> bool:
    if isinstance(ip, IPv4Address):
        return not any(ip in network for network in SPECIAL_IPV4)
    return ip in GLOBAL_UNICAST and not any(ip in network for network in SPECIAL_IPV6)
