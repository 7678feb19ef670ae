"""Which processes still run."""

import os
import subprocess
import sys

from surefoot.files.processes import has_ended


def test_only_a_process_that_is_known_to_have_ended_has():
    gone = subprocess.Popen([sys.executable, "-S", "-c", ""])
    gone.wait()
    assert has_ended(str(gone.pid))
    assert not has_ended(str(os.getpid()))
    assert not has_ended("1") and not has_ended("x") and not has_ended("")
