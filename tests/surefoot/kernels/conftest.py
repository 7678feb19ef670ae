import pytest

from tests.surefoot.kernels.processes import HIGH, LOW, Processes


@pytest.fixture(scope="package")
def processes():
    started = Processes()
    yield started
    started.end()


@pytest.fixture
def place(tmp_path):
    """A folder with the modules ``low`` and ``high``, and the cache of those who use them."""
    (tmp_path / "low.py").write_text(LOW.format(body="pass"))
    (tmp_path / "high.py").write_text(HIGH)
    return tmp_path
