"""The name of the machine, for pages that print seconds."""

import os
import platform
from pathlib import Path


def describe():
    """Processor, cores, Python; one line."""
    cpu = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [line.split(":", 1)[1].strip() for line in info.read_text().splitlines() if line.startswith("model name")]
        cpu = names[0] if names else cpu
    return f"{cpu}, {os.cpu_count()} cores, one thread used, Python {platform.python_version()}"
