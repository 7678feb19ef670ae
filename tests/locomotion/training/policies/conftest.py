"""What the tests of policies share."""

import pytest

from locomotion.training.policies.reference import Reference, make_reference


@pytest.fixture(scope="session")
def reference() -> Reference:
    """Made once: it takes seconds."""
    return make_reference()
