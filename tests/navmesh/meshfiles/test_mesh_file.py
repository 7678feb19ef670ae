"""What readers of mesh files give, and how they refuse one."""

import numpy as np

from navmesh import NavmeshError
from navmesh.meshfiles.mesh_file import MeshFileError, flattened, missing_extra


def test_parts_come_one_after_the_other():
    one = np.arange(9.0).reshape(3, 3), np.array([[0, 1, 2]])
    two = np.ones((4, 3)), np.array([[0, 1, 2], [0, 2, 3]])
    vertices, faces = flattened([one, two])
    assert vertices.shape == (7, 3) and np.array_equal(vertices[3:], two[0])
    assert faces.tolist() == [[0, 1, 2], [3, 4, 5], [3, 5, 6]]
    vertices, faces = flattened([])
    assert vertices.shape == faces.shape == (0, 3) and faces.dtype == np.int64


def test_an_error_says_which_file_where_and_what():
    assert issubclass(MeshFileError, NavmeshError)
    assert (
        str(MeshFileError("a.obj", "line 3", "is wrong"))
        == "a.obj: cannot be read as a mesh: line 3: is wrong"
    )
    assert str(MeshFileError("a.obj", "", "is wrong")) == "a.obj: cannot be read as a mesh: is wrong"
    said = str(missing_extra("a.usd", "needs usd-core", "usd", "export it as glTF"))
    assert said.endswith(
        "needs usd-core; in Surefoot's folder: pip install -e '.[usd]', or export it as glTF"
    )
