"""Workers on other machines, by Dask (the extra "cluster").

A task is a function and one item. What all tasks of a pool need, such as a level's graph, travels once to
each worker and is known by its digest there. Workers may come, go and die: a task whose worker died is done
by another, and results are put in order by their items, so they are those of one machine.

Dask's peers unpickle what they send each other, so whoever reaches a port can run code behind it. Machines
are therefore only talked to under TLS, and without it only this machine is.
"""

import hashlib
import ipaddress
import logging
import pickle
import threading
import uuid
import warnings
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

from surefoot.errors import SurefootError
from surefoot.workers.versions import differences, own_versions

if TYPE_CHECKING:
    from distributed import Client, Future

__all__ = ["ClusterError", "checked_address", "cluster_pool"]

_FIRST_WORKER = 60.0  # [s] until somebody must be there
_DEATHS = 10  # of workers, with one task, before that is said to be the task's fault
_AHEAD = 4  # tasks in flight for each worker: enough to keep it busy, few enough to bound our memory


class ClusterError(SurefootError):
    """A cluster that cannot be used, or is gone."""


def checked_address(address: str) -> str:
    """``address`` of a cluster: "tls://HOST:PORT", "tcp://HOST:PORT" on this machine, or "local:N", which
    starts N workers here. Raises `ClusterError` for anything else."""
    expected = "expected tls://HOST:PORT, tcp://127.0.0.1:PORT or local:N"
    kind, _, rest = address.partition(":")
    if kind == "local":
        if not rest.isdecimal() or int(rest) < 1:
            raise ClusterError(f"cluster {address!r}: {expected}, with N workers, 1 or more")
        return address
    host, _, port = rest.removeprefix("//").rpartition(":")
    if kind not in ("tcp", "tls") or not rest.startswith("//") or not host or not port.isdecimal():
        raise ClusterError(f"cluster {address!r}: {expected}")
    if kind == "tcp" and not _is_here(host.strip("[]")):
        raise ClusterError(
            f"cluster {address!r}: anybody who reaches an open port could run code on these machines; use "
            "tls://, see docs/guides/cluster.md"
        )
    return address


def _is_here(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


@contextmanager
def cluster_pool(address: str, begin: Callable[..., None], arguments: tuple[Any, ...]) -> Iterator[Any]:
    """The workers of the cluster at ``address``; see `surefoot.workers.pool.worker_pool`."""
    # what it has to say, our errors say in a sentence
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    with _client(checked_address(address)) as client:
        _check_versions(client)
        yield _Cluster(client, address, pickle.dumps((begin, arguments, own_versions())))


@contextmanager
def _client(address: str) -> Iterator["Client"]:
    try:
        import distributed
    except ImportError:
        raise ClusterError(
            f"cluster {address!r}: needs the extra 'cluster': pip install surefoot[cluster]"
        ) from None
    if address.startswith("local:"):
        with (
            distributed.LocalCluster(
                n_workers=int(address.partition(":")[2]), threads_per_worker=1, host="127.0.0.1",
                dashboard_address=None,  # type: ignore[arg-type]  # none
                silence_logs=logging.CRITICAL,
            ) as cluster,
            distributed.Client(cluster, set_as_default=False) as client,
        ):  # fmt: skip
            yield client
        return
    security = distributed.Security(require_encryption=address.startswith("tls:"))
    if address.startswith("tls:") and security.get_connection_args("client").get("ssl_context") is None:
        raise ClusterError(
            f"cluster {address!r}: no certificates; Dask reads them from its configuration "
            "(DASK_DISTRIBUTED__COMM__TLS__CA_FILE, ...__CLIENT__CERT and ...__CLIENT__KEY)"
        )
    try:
        client = distributed.Client(address, security=security, set_as_default=False, timeout="10s")
    except (OSError, TimeoutError) as error:
        raise ClusterError(f"cluster {address!r}: no scheduler answers there: {error}") from None
    with client:
        try:
            client.wait_for_workers(1, timeout=_FIRST_WORKER)
        except TimeoutError:
            raise ClusterError(f"cluster {address!r}: no worker came in {_FIRST_WORKER:.0f} s") from None
        yield client


def _check_versions(client: "Client") -> None:
    ours = own_versions()
    try:
        answers = cast(dict[str, dict[str, str]], client.run(own_versions))
    except Exception as error:
        raise ClusterError(f"a worker has no surefoot {ours['surefoot']}: {error}") from None
    for worker, theirs in answers.items():
        different = differences(ours, theirs)
        if different:
            raise ClusterError(f"the worker {worker} is of another release: {different}")


@dataclass
class _Task:
    """A task that was sent."""

    func: Callable[[Any], Any]
    item: Any
    number: int
    deaths: int = 0
    future: "Future | None" = None


class _Cluster:
    def __init__(self, client: "Client", address: str, common: bytes) -> None:
        self._client, self._address = client, address
        self._digest = hashlib.sha256(common).hexdigest()
        self._sent = 0
        self._name = f"surefoot-{uuid.uuid4().hex}"  # other clients of the scheduler have names of their own
        with warnings.catch_warnings():  # of its size
            warnings.simplefilter("ignore", UserWarning)
            self._common = client.submit(_kept, common, key=self._name, pure=False)

    def map(self, func: Callable[[Any], Any], iterable: Iterable[Any], chunksize: int | None = None) -> list:
        return list(self._in_order(func, iterable, None))

    def imap(self, func: Callable[[Any], Any], iterable: Iterable[Any]) -> Iterator[Any]:
        workers = sum(cast(dict[str, int], self._client.nthreads()).values())
        return self._in_order(func, iterable, _AHEAD * max(workers, 1))

    def _in_order(self, func: Callable[[Any], Any], items: Iterable[Any], most: int | None) -> Iterator[Any]:
        """Results in the order of the items, with at most ``most`` tasks in flight."""
        flying: deque[_Task] = deque()
        for item in items:
            flying.append(self._send(_Task(func, item, self._sent)))
            self._sent += 1
            if most is not None and len(flying) >= most:
                yield self._result(flying.popleft())
        while flying:
            yield self._result(flying.popleft())

    def _send(self, task: _Task) -> _Task:
        key = f"{self._name}-{task.number}-{task.deaths}"
        task.future = self._client.submit(
            _work, self._digest, self._common, task.func, task.item, key=key, pure=False
        )
        return task

    def _result(self, task: _Task) -> Any:
        from distributed import KilledWorker

        while True:
            future = task.future
            assert future is not None
            try:
                return future.result()
            except KilledWorker:
                task.deaths += 1
                if task.deaths >= _DEATHS:
                    raise ClusterError(
                        f"cluster {self._address!r}: task {task.number} has lost its worker again and again"
                    ) from None
                self._send(task)
            except BaseException:
                if future.status == "error":
                    raise  # the task's own error
                if future.status in ("cancelled", "lost"):
                    raise ClusterError(
                        f"cluster {self._address!r}: the scheduler is gone; start it and run the same again"
                    ) from None
                raise


def _kept(common: bytes) -> bytes:
    """Stays where the tasks are."""
    return common


_turn = threading.Lock()
_begun = ""  # digest of what this process was initialised with


def _work(digest: str, common: bytes, func: Callable[[Any], Any], item: Any) -> Any:
    """On the worker: initialise this process, where it is not yet, and do a task. One at a time: what a pool
    begins is the process's."""
    global _begun
    with _turn:
        if _begun != digest:
            begin, arguments, versions = pickle.loads(common)
            different = differences(versions, own_versions())
            if different:
                raise ClusterError(f"a worker is of another release: {different}")
            begin(*arguments)
            _begun = digest
        return func(item)
