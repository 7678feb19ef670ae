"""Sets that are joined two by two, as arrays of parents (union-find with path halving)."""

from surefoot.kernels import kernel

__all__ = ["root"]


@kernel
def root(parent, k):
    """The member that stands for the set of ``k``; those on the way there are brought nearer to it."""
    while parent[k] != k:
        parent[k] = parent[parent[k]]
        k = parent[k]
    return k
