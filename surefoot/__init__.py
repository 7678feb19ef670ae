"""What the packages `navmesh`, `pathsmooth`, `locomotion` and `runtime` share; ``python -m surefoot`` is the
command ``surefoot``."""

__all__ = ["__version__"]

__version__ = "0.1.0"
