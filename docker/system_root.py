"""Copies a few Debian packages, with what they need to run, to where an image begins with nothing.

    system_root.py DIRECTORY PACKAGE...

No shell, no package installer and no manual goes along. What is there is listed as scanners for
known weaknesses look for it, in `/var/lib/dpkg/status.d`.
"""

import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Iterator
from email.message import Message
from email.parser import Parser
from pathlib import Path

STATUS = Path("/var/lib/dpkg/status")

ONLY_WHILE_INSTALLING = {"debconf", "dpkg", "openssl"}
"""Packages that others name because their installation runs them."""

NOT_READ = (
    "/usr/share/bug/",
    "/usr/share/doc/",
    "/usr/share/info/",
    "/usr/share/lintian/",
    "/usr/share/locale/",
    "/usr/share/man/",
)
"""Below these nothing is read at run time, but for the licences."""

CONVERSIONS = re.compile(r"/usr/lib/[^/]+/gconv/")
"""Of character sets that Python has its own tables for; below a folder of each architecture."""

MADE_HERE = (
    "/etc/group",
    "/etc/ld.so.cache",
    "/etc/localtime",
    "/etc/nsswitch.conf",
    "/etc/passwd",
    "/etc/ssl/certs/ca-certificates.crt",
)
"""What belongs to no package, as it is made when they are installed."""


def installed() -> dict[str, Message]:
    """Every installed package, by its name and by what it provides."""
    packages: dict[str, Message] = {}
    for text in STATUS.read_text("utf-8").split("\n\n"):
        package = Parser().parsestr(text)
        if str(package["Status"]).endswith(" installed"):
            for name in [package["Package"], *_names(package["Provides"])]:
                packages.setdefault(name, package)
    return packages


def _names(relations: str | None) -> Iterator[str]:
    """The names in a list of relations, without versions and architectures."""
    for relation in re.split(r"[,|]", relations or ""):
        if relation.strip():
            yield re.split(r"[ (:]", relation.strip())[0]


def with_needed(packages: dict[str, Message], names: Iterable[str]) -> dict[str, Message]:
    """These packages and all that they depend on, by their own names."""
    found: dict[str, Message] = {}
    waiting = list(names)
    while waiting:
        package = packages.get(waiting.pop())
        if package is None or package["Package"] in found | dict.fromkeys(ONLY_WHILE_INSTALLING):
            continue
        found[package["Package"]] = package
        # Of alternatives, those that are installed.
        waiting += [*_names(package["Depends"]), *_names(package["Pre-Depends"])]
    return found


def files_of(name: str) -> list[str]:
    """The absolute paths of a package's files, directories among them."""
    listed = subprocess.run(["dpkg-query", "-L", name], check=True, capture_output=True, text=True)
    return [line for line in listed.stdout.splitlines() if line.startswith("/")]


def copy(path: str, root: Path) -> None:
    """Put a file where it is below `root`; links stay links, directories come as needed.

    Images are made without some files of their packages: those are no loss.
    """
    source = Path(path)
    if not source.is_symlink() and not source.is_file():
        return
    # A directory of the package may be a link in the system: /lib is /usr/lib.
    target = root / source.parent.resolve().relative_to("/") / source.name
    if target.is_symlink() or target.exists():
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy2(source, target, follow_symlinks=False)


def is_read(path: str) -> bool:
    """Whether it is to go along."""
    unread = path.startswith(NOT_READ) or CONVERSIONS.match(path)
    return path.endswith("/copyright") or not unread


def make(root: Path, names: list[str]) -> None:
    packages = installed()
    missing = [name for name in names if name not in packages]
    if missing:
        sys.exit(f"not installed here: {', '.join(missing)}")
    status = root / "var/lib/dpkg/status.d"
    status.mkdir(parents=True)
    for directory in ("bin", "lib", "lib64", "sbin"):
        copy(f"/{directory}", root)
    for name, package in with_needed(packages, names).items():
        for path in filter(is_read, files_of(name)):
            copy(path, root)
        (status / name).write_text(package.as_string(), "utf-8")
    for path in MADE_HERE:
        copy(path, root)
    (root / "tmp").mkdir()
    (root / "tmp").chmod(0o1777)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    make(Path(sys.argv[1]), sys.argv[2:])
