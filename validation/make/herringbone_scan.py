"""Article S4's ten rows under every reading of what it does not print; a stopped run goes on where it was."""

from ..shared import herringbone_scan as scan
from ..shared import herringbone_scan_nodes as nodes
from ..shared.herringbone_scan_page import to_check, write


def run():
    """Continue the nodes, the scan and its checks; draw the picture, write the page."""
    nodes.compute()
    scan.compute()
    scan.check(to_check())
    write()
