"""Strips of triangles."""

import numpy as np

__all__ = ["strip_faces"]


def strip_faces(corners: np.ndarray, lengths: np.ndarray) -> np.ndarray:
    """(f, 3) int64: the triangles of strips, all turned as the first of their strip.

    ``corners`` (k,) are strip after strip, of which ``lengths`` (s,) says how many each has; a negative one
    begins another strip.
    """
    faces = [np.empty((0, 3), np.int64)]
    for strip in np.split(np.asarray(corners, dtype=np.int64), np.cumsum(lengths)[:-1]):
        for run in np.split(strip, np.flatnonzero(strip < 0)):
            run = run[run >= 0]
            step = np.arange(max(len(run) - 2, 0))
            odd = step % 2
            faces.append(np.stack([run[step], run[step + 1 + odd], run[step + 2 - odd]], axis=1))
    return np.concatenate(faces)
