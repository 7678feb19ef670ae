"""Workers on a cluster: the same results in the same order, whoever dies."""

import logging
import operator
import pickle

import pytest

from surefoot.workers import cluster
from surefoot.workers.cluster import ClusterError, checked_address
from surefoot.workers.pool import worker_pool
from surefoot.workers.versions import own_versions
from tests.surefoot.workers.test_pool import BASE, begin, fail, shifted

distributed = pytest.importorskip("distributed", reason="needs the extra 'cluster'")


@pytest.fixture(scope="module")
def address():
    """A scheduler and two workers in this process, which are reached as if they were elsewhere."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=False, protocol="tcp://", host="127.0.0.1",
        dashboard_address=None, silence_logs=logging.CRITICAL,
    ) as started:  # fmt: skip
        yield started.scheduler_address
    BASE["of"] = 0


def test_results_come_in_the_order_of_the_items(address):
    with worker_pool(address, begin, (10,)) as workers:
        assert workers.map(shifted, range(6), chunksize=1) == [10, 11, 12, 13, 14, 15]
        assert list(workers.imap(shifted, range(40))) == list(range(10, 50))
        with pytest.raises(OSError, match="full"):
            workers.map(fail, [0])
    with worker_pool(address, begin, (20,)) as workers:
        assert workers.map(shifted, [1]) == [21]


def test_items_are_taken_as_they_are_needed(address):
    taken = []

    def items():
        for k in range(1000):
            taken.append(k)
            yield k

    with worker_pool(address, begin, (0,)) as workers:
        assert [next(workers.imap(shifted, items())) for _ in range(1)] == [0]
    assert len(taken) <= 16


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("tcp://10.0.0.7:8786", "anybody who reaches an open port"),
        ("tcp://example.org:8786", "use tls://"),
        ("local:0", "with N workers, 1 or more"),
        ("local:", "1 or more"),
        ("tcp://127.0.0.1", "expected tls://HOST:PORT"),
        ("http://127.0.0.1:80", "expected tls://HOST:PORT"),
        ("", "expected tls://HOST:PORT"),
    ],
)
def test_other_addresses_are_refused(given, said):
    with pytest.raises(ClusterError, match=said):
        checked_address(given)


@pytest.mark.parametrize("given", ["tls://example.org:8786", "tcp://localhost:1", "tcp://[::1]:1", "local:4"])
def test_addresses_that_may_be_used(given):
    assert checked_address(given) == given


def test_tls_without_certificates_says_where_they_are_looked_for():
    with pytest.raises(ClusterError, match="DASK_DISTRIBUTED__COMM__TLS__CA_FILE"):
        with worker_pool("tls://127.0.0.1:8786", begin, (0,)):
            pass


class Asked:
    """A client whose workers answer this."""

    def __init__(self, **answers):
        self.answers = answers

    def run(self, _):
        return self.answers


def test_workers_of_another_release_are_refused_by_name():
    ours = own_versions()
    cluster._check_versions(Asked(one=ours, two=ours))
    said = rf"the worker two is of another release: numpy 1\.0 \(here {ours['numpy']}\)"
    with pytest.raises(ClusterError, match=said):
        cluster._check_versions(Asked(one=ours, two={**ours, "numpy": "1.0"}))


def test_a_worker_that_comes_later_is_refused_too():
    other = pickle.dumps((begin, (0,), {**own_versions(), "numpy": "1.0"}))
    with pytest.raises(ClusterError, match=r"a worker is of another release: numpy .* \(here 1\.0\)"):
        cluster._work("its digest", other, shifted, 1)


class Future:
    """One that ends as told."""

    def __init__(self, ends, status="finished"):
        self.ends, self.status = ends, status

    def result(self):
        if isinstance(self.ends, BaseException):
            raise self.ends
        return self.ends


class Client:
    """Gives the futures that it was made with, one after the other; the first is the common part."""

    def __init__(self, *futures):
        self.futures, self.keys = [Future(b""), *futures], []

    def submit(self, *_, key, pure):
        self.keys.append(key)
        return self.futures.pop(0)


def killed():
    return Future(distributed.KilledWorker("task", None, 3), "error")


def test_a_task_whose_worker_died_is_done_by_another():
    client = Client(killed(), Future("b"), Future("a"))
    pool = cluster._Cluster(client, "tcp://there", b"")
    assert pool.map(operator.neg, [0, 1]) == ["a", "b"]
    assert len(set(client.keys)) == 4


def test_a_task_that_kills_every_worker_is_given_up():
    client = Client(*[killed() for _ in range(cluster._DEATHS)])
    with pytest.raises(ClusterError, match="task 0 has lost its worker again and again"):
        cluster._Cluster(client, "tcp://there", b"").map(operator.neg, [0])


def test_a_scheduler_that_is_gone_is_said_to_be():
    client = Client(Future(distributed.client.FutureCancelledError("x", "gone"), "cancelled"))
    with pytest.raises(ClusterError, match="'tcp://there': the scheduler is gone; start it and run the same"):
        cluster._Cluster(client, "tcp://there", b"").map(operator.neg, [0])
