"""What the tests of policies share."""

import pytest

from locomotion.training.policies.reference import Reference, make_reference
from locomotion.training.policies.running_reference import with_run


@pytest.fixture(scope="session")
def reference() -> Reference:
    """Made once: it takes seconds."""
    return make_reference()


@pytest.fixture(scope="session")
def both(reference: Reference) -> Reference:
    """That of walks and runs."""
    return with_run(reference)
