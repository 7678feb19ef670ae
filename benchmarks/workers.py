"""Where benchmarks that try many starts make them: ``--processes`` of this machine, or a ``--cluster``.

Workers import the benchmark: start those of a cluster in this folder. Figures are the same wherever they are
made.
"""

import argparse

from surefoot.workers.cluster import checked_address
from surefoot.workers.pool import Place

__all__ = ["add_place", "place_of"]


def add_place(parser: argparse.ArgumentParser) -> None:
    """Give ``parser`` the two options."""
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--cluster", metavar="ADDRESS", help="as of `surefoot evaluate`")


def place_of(options: argparse.Namespace) -> Place:
    """What they say. Raises `surefoot.workers.cluster.ClusterError` for what is no address."""
    return options.processes if options.cluster is None else checked_address(options.cluster)
