"""Memory available to a process by the computer, the limit of the process and its control group (container)."""

import math
import os
from pathlib import Path

GROUP = "/sys/fs/cgroup"  # control group of this process: version 2, then version 1
CONTROL_GROUP = (  # files with the limit, the use and details [bytes], and the entry for cached files in the details
    (f"{GROUP}/memory.max", f"{GROUP}/memory.current", f"{GROUP}/memory.stat", "inactive_file"),
    (f"{GROUP}/memory/memory.limit_in_bytes", f"{GROUP}/memory/memory.usage_in_bytes", f"{GROUP}/memory/memory.stat",
     "total_inactive_file"),
)  # fmt: skip


def free_memory():
    """Return the memory [bytes] available without swapping: the free memory of the computer, or a smaller limit."""
    return min(_machine_free(), _process_free(), _group_free())


def check_memory(what: str, needed: float, remedy: str) -> None:
    """Raise ValueError if `what` needs more memory [bytes] than is free. The message has both numbers, and the `remedy`."""
    if needed > (free := free_memory()):
        raise ValueError(f"{what} needs about {needed / 1e9:.3g} GB, but {free / 1e9:.3g} GB are free: {remedy}")


def _process_free():
    """Return the unused part of the limit of this process (``ulimit -v``, ``ulimit -d``)."""
    try:
        import resource
    except ImportError:  # This system has no such limits.
        return math.inf
    soft = [resource.getrlimit(kind)[0] for kind in (resource.RLIMIT_AS, resource.RLIMIT_DATA)]
    least = min((float(limit) for limit in soft if limit != resource.RLIM_INFINITY), default=math.inf)
    if least == math.inf:
        return least
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            used = float(file.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        used = 0.0
    return max(least - used, 0.0)


def _group_free():
    """Return the unused part of the control group of this process (a container).

    Versions 1 and 2 have different files.
    """
    left = math.inf
    for limit, used, details, cached in CONTROL_GROUP:
        try:
            most, taken, lines = (Path(name).read_text(encoding="ascii").strip() for name in (limit, used, details))
        except OSError:
            continue
        files = next((float(line.split()[1]) for line in lines.splitlines() if line.startswith(f"{cached} ")), 0.0)
        if most.isdigit() and taken.isdigit():  # Cached files are released on demand.
            left = min(left, max(float(most) - float(taken) + files, 0.0))
    return left


def _machine_free():
    try:
        with open("/proc/meminfo", encoding="ascii") as lines:
            for line in lines:
                if line.startswith("MemAvailable"):
                    return 1024.0 * int(line.split()[1])
    except OSError:
        pass
    return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")) if hasattr(os, "sysconf") else math.inf
