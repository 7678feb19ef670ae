"""Code shared by the packages `navmesh`, `pathsmooth`, `locomotion` and `runtime`; ``python -m surefoot``
runs the command ``surefoot``."""

from surefoot.errors import SurefootError

__all__ = ["SurefootError", "__version__"]

__version__ = "0.1.0"
