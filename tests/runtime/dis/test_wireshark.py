"""Wireshark's dissector reads our PDUs as we wrote them."""

import shutil

import pytest

from benchmarks.dis_wireshark import differences, random_pdus


@pytest.mark.skipif(shutil.which("tshark") is None, reason="needs tshark: apt-get install tshark")
def test_every_field_is_read_as_it_was_written(tmp_path):
    """Thirty PDUs; the benchmark takes 1,000."""
    pdus = random_pdus(30, seed=8)
    assert differences(pdus, tmp_path) == []
