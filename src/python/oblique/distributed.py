# SPDX-License-Identifier: MIT
"""Ensembles on many computers, by Dask distributed (Debian: python3-distributed).

>>> import oblique as ob
>>> from oblique import distributed
>>> plan = ob.Plan.of("diagrams/lessons/triangle-side.toml", vary={"c.gain": "1e2..1e4:30:log"},
...                   measure={"largest": "max(side)"})
>>> sides = distributed.run(plan, "tcp://scheduler:8786", chunks=4)     # doctest: +SKIP

Chunks go to the workers a few at a time, each a task. What comes back is a chunk's file, byte for byte, so that a result is
that of the serial run whichever worker made which chunk, and whatever was lost on the way: workers may die, the scheduler may
be killed and started again. The workers need this package, in the same version, and the files that a diagram reads (not the
diagram itself).
"""

from __future__ import annotations

import collections
import os
import time
from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _arguments, _oblique
from ._arguments import Number, PathLike, Quantity
from ._errors import Error, PlanError, RequestError
from ._tables import _missing
from .ensemble import EnsembleRun, Interrupted, Plan

if TYPE_CHECKING:
    import distributed

# How often futures are looked at [s]: beside a chunk of a second it is nothing.
_PAUSE = 0.02


@lru_cache(maxsize=8)
def _opened(parts: tuple[Any, ...]) -> Plan:
    """The plan of a worker: read once, not for every chunk."""
    text, file, subject, folders = parts
    from ._blocks import BlockLibrary
    return Plan._of_parts(text, file, subject, BlockLibrary(*folders), 1)


def _make(parts: tuple[Any, ...], identity: tuple[str, ...], number: int, chunks: int, seconds: Optional[float]) -> bytes:
    """On a worker: the bytes of a chunk."""
    raw = _opened(parts)._raw
    if raw.identity != identity:
        what = "version of Oblique" if raw.identity[0] != identity[0] else "diagram, plan, files or blocks"
        raise PlanError(f"the worker has another {what} than the one that asks",
                        f"{', '.join(identity)}, and not {', '.join(raw.identity)}",
                        "give all computers the same files and the same version")
    return raw.chunk_bytes(number, chunks, seconds)


def run(plan: Union[Plan, PathLike], client: Union["distributed.Client", str], *, chunks: Optional[int] = None,
        folder: Optional[PathLike] = None, batch: Optional[int] = None, retries: int = 3,
        time_limit: Optional[Quantity] = None, allowed_failures: int = 1000, patience: Number = 300,
        progress: Optional[Callable[[int, int], object]] = None) -> EnsembleRun:
    """Runs a plan on the workers of a cluster, and gives all rows.

    `client` is a distributed.Client or the address of a scheduler. The ensemble is cut into `chunks` (of about 1000 runs);
    `batch` of them are with the cluster at a time (two for each thread of it). With a `folder` each chunk is kept there as a
    file as soon as it has come, what is there already is not run, and `oblique ensemble gather` reads it; without one the rows
    stay in memory. A chunk that fails is tried `retries` times more; `time_limit` [s] ends it between two machines.
    A worker that dies is no failure of the chunks on it: it may happen to each `allowed_failures` times. A scheduler that is
    lost is waited for so long [s]: `patience`. `progress(done, chunks)` is called when chunks have come.

    Ctrl-C throws Interrupted, which has the rows of the chunks that are done. Throws PlanError where a chunk cannot be had, and what reading the plan throws."""
    if not isinstance(plan, Plan):
        plan = Plan(plan)
    cut = plan.chunks(chunks)
    limit = None if time_limit is None else _arguments.positive("time_limit", time_limit, "s")
    most = None if batch is None else _arguments.count("batch", batch)
    into = None if folder is None else _arguments.path("folder", folder)
    if into is not None and os.path.isdir(into):
        plan.status(into)  # what does not belong there is known before the work
    run_ = _Run(plan, cut, into, _arguments.count("retries", retries, 0), limit,
                _arguments.count("allowed_failures", allowed_failures, 0), _arguments.positive("patience", patience, "s"))
    cluster = _Cluster(client, run_.allowed_failures, run_.patience)
    try:
        run_.finish(cluster, most, progress)
    finally:
        cluster.close()
    return run_.result()


class _Cluster:
    """A client that is there again when its scheduler is."""

    def __init__(self, client: Union["distributed.Client", str], allowed_failures: int, patience: float) -> None:
        try:
            import distributed
        except ImportError:
            raise _missing("distributed") from None
        self._kind: Any = distributed.Client
        self.client: Any
        self.address: str
        self._allowed_failures = allowed_failures
        self._patience = patience
        self._own = False
        if isinstance(client, str):
            self.address = client
            self.client = self._connect()
        elif isinstance(client, distributed.Client):
            if client.scheduler is None or client.status == "closed":
                raise RequestError("client= is closed", "a distributed.Client that is connected")
            self.address = str(client.scheduler.address)
            self.client = client
        else:
            raise RequestError(f"client={_arguments.shown(client)} is no client", "a distributed.Client, or the address of a scheduler")
        self.prepare()

    def _connect(self) -> Any:
        self._own = True
        try:
            return self._kind(self.address, timeout=self._patience, set_as_default=False)
        except (OSError, TimeoutError) as error:
            raise PlanError(f"no scheduler of Dask answers at {self.address}: {error}",
                            remedy="start one (dask-scheduler) and give the address that it prints") from None
        except ValueError as error:
            raise RequestError(f"client=\"{self.address}\" is no address: {error}", '"tcp://computer:8786"') from None

    def prepare(self) -> None:
        """A worker that dies makes every task on it suspicious: that of a few small chunks is no reason to give up."""
        allowed = self._allowed_failures

        def allow(dask_scheduler: Any) -> None:
            dask_scheduler.allowed_failures = max(dask_scheduler.allowed_failures, allowed)

        self.client.run_on_scheduler(allow)

    def threads(self) -> int:
        return sum(self.client.ncores().values())

    def come_back(self) -> None:
        """Waits for the scheduler. Throws PlanError where it does not come."""
        end = time.monotonic() + self._patience
        while time.monotonic() < end:
            try:
                if self.client.status == "closed":
                    left = max(1.0, end - time.monotonic())
                    self._own = True
                    self.client = self._kind(self.address, timeout=min(left, 10.0), set_as_default=False)
                if self.client.status == "running":
                    self.prepare()
                    return
            except Exception:  # not yet: whatever a connection throws that comes and goes
                pass
            time.sleep(0.2)
        raise PlanError(f"the scheduler at {self.address} was lost, and did not come back in {self._patience:g} s",
                        remedy="start it again and call this again: with folder= what is done is not run again")

    def close(self) -> None:
        if self._own:
            try:
                self.client.close(timeout=5)
            except Exception:  # its scheduler may be gone
                pass


class _Run:
    """What is done of an ensemble, and what is not."""

    def __init__(self, plan: Plan, chunks: int, folder: Optional[str], retries: int, limit: Optional[float],
                 allowed_failures: int, patience: float) -> None:
        self.plan, self.chunks, self.folder, self.retries, self.limit = plan, chunks, folder, retries, limit
        self.allowed_failures, self.patience = allowed_failures, patience
        raw = plan._raw
        self._parts = (plan._text, plan._file, raw.subject, tuple(plan._blocks._folders))
        self._kept: dict[int, bytes] = {}
        self._tries: collections.Counter[int] = collections.Counter()
        self._begun = 0
        self._todo = collections.deque(
            number for number in range(chunks) if folder is None or not raw.is_done(number, chunks, folder))
        self._with_cluster: dict[Any, int] = {}

    def finish(self, cluster: _Cluster, batch: Optional[int], progress: Optional[Callable[[int, int], object]]) -> None:
        try:
            self._work(cluster, batch, progress)
        except KeyboardInterrupt:
            self._cancel()
            again = "; called again with the same folder= it goes on" if self.folder is not None else ""
            raise Interrupted(self.done(), self.plan.runs, again) from None
        except BaseException:
            self._cancel()
            raise

    def _work(self, cluster: _Cluster, batch: Optional[int], progress: Optional[Callable[[int, int], object]]) -> None:
        waited = time.monotonic()
        while self._todo or self._with_cluster:
            try:
                if self._todo and (batch is None or len(self._with_cluster) < batch):
                    self._submit(cluster, batch if batch is not None else max(2, 2 * cluster.threads()))
                came = self._take()
            except Error:
                raise
            except Exception:  # the connection: the scheduler is lost, and with it all that it knew
                came = 0
                self._give_back()
                cluster.come_back()
            if came:
                waited = time.monotonic()
                if progress is not None:
                    progress(self.chunks - len(self._todo) - len(self._with_cluster), self.chunks)
            else:
                if cluster.client.status != "running":
                    self._give_back()
                    cluster.come_back()
                    waited = time.monotonic()
                elif time.monotonic() - waited > self.patience and not cluster.threads():
                    raise PlanError(f"the scheduler at {cluster.address} has had no worker for {self.patience:g} s",
                                    remedy="start workers (dask-worker) and call this again")
                time.sleep(_PAUSE)

    def _submit(self, cluster: _Cluster, most: int) -> None:
        identity = self.plan._raw.identity
        while self._todo and len(self._with_cluster) < most:
            number = self._todo[0]
            # A name of its own each time: the scheduler would give back what became of the last one.
            self._begun += 1
            key = f"oblique-{identity[1][:8]}-{number}-of-{self.chunks}-{self._begun}-{time.time_ns():x}"
            future = cluster.client.submit(_make, self._parts, identity, number, self.chunks, self.limit, key=key, pure=False)
            self._with_cluster[future] = self._todo.popleft()

    def _take(self) -> int:
        """Takes what has come; so many chunks."""
        came = 0
        for future in [one for one in self._with_cluster if one.status != "pending"]:
            number = self._with_cluster[future]
            if future.status == "finished":
                self._keep(number, future.result(timeout=60))
                came += 1
            elif future.status == "error":
                self._failed(number, future.exception(timeout=60))
            else:  # cancelled, lost
                self._todo.appendleft(number)
            del self._with_cluster[future]
            future.release()
        return came

    def _keep(self, number: int, content: bytes) -> None:
        if self.folder is None:
            self._kept[number] = content
        else:
            self.plan._raw.store(number, self.chunks, content, self.folder)

    def _failed(self, number: int, error: BaseException) -> None:
        self._tries[number] += 1
        if self._tries[number] <= self.retries:
            self._todo.append(number)
            return
        remedy = error.remedy if isinstance(error, Error) else ""
        if isinstance(error, ImportError):
            remedy = "install this package on the workers, in the same version"
        what = error.what if isinstance(error, Error) else f"{type(error).__name__}: {error}"
        expected = error.expected if isinstance(error, Error) else ""
        raise PlanError(f"chunk {number}/{self.chunks} failed {self._tries[number]} times: {what}", expected, remedy) from error

    def _give_back(self) -> None:
        self._todo.extendleft(self._with_cluster.values())
        self._with_cluster.clear()

    def _cancel(self) -> None:
        for future in self._with_cluster:
            try:
                future.cancel()
            except Exception:  # there is nobody who would do it any more
                pass
        self._with_cluster.clear()

    def result(self) -> EnsembleRun:
        return self.done() if self.folder is None else self.plan.gather(self.folder)

    def done(self) -> EnsembleRun:
        """Of the chunks that there are."""
        raw = self.plan._raw
        rows, failures, counts, numbers = [], [], collections.Counter[str](), []
        reasons = collections.Counter[str]()
        for number in range(self.chunks):
            content = self._content(number)
            if content is None:
                continue
            found, failed, count = raw.read_chunk(number, self.chunks, content)
            rows.append(found)
            numbers.append(np.arange(len(found)) + raw.first_run(number, self.chunks))
            failures += failed
            counts.update({"in_lanes": count["in_lanes"], "by_cvodes": count["by_cvodes"]})
            reasons.update(count["reasons"])
        return EnsembleRun(raw.columns, raw.n_varied, np.concatenate(rows) if rows else np.empty((0, len(raw.columns))), failures,
                           {"in_lanes": counts["in_lanes"], "by_cvodes": counts["by_cvodes"], "reasons": reasons},
                           np.concatenate(numbers) if numbers else np.empty(0, dtype=np.int64))

    def _content(self, number: int) -> Optional[bytes]:
        if self.folder is None:
            return self._kept.get(number)
        raw = self.plan._raw
        if not raw.is_done(number, self.chunks, self.folder):
            return None
        return _oblique.read_file(os.path.join(self.folder, raw.file_name(number, self.chunks)))
