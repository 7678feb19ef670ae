"""Every change in a file with kernels is noticed."""

import surefoot
from surefoot.kernels.sources import digest_of_sources


def test_the_digest_is_that_of_all_their_contents(monkeypatch, tmp_path):
    monkeypatch.setattr(surefoot, "__file__", str(tmp_path / "surefoot" / "__init__.py"))
    (tmp_path / "navmesh").mkdir()
    file, plain = tmp_path / "navmesh" / "one.py", tmp_path / "navmesh" / "two.py"
    file.write_text("@kernel\ndef one(): ...\n")
    plain.write_text("def two(): ...\n")
    digests = []
    for where, text in ((plain, "def three(): ...\n"), (file, "@kernel\ndef one(): pass\n")):
        digest_of_sources.cache_clear()
        before = digest_of_sources()
        where.write_text(text)
        digest_of_sources.cache_clear()
        digests.append(digest_of_sources() == before)
    digest_of_sources.cache_clear()
    assert digests == [True, False]
