# SPDX-License-Identifier: MIT
"""Ensembles on a cluster of Dask: a scheduler and workers of its own on the loopback, which are killed on the way."""

import os
import signal
import socket
import subprocess
import sys
import threading
import time

import pytest

import oblique as ob

distributed = pytest.importorskip("distributed", reason="distributed is not installed (Debian: python3-distributed)")

from oblique import distributed as on_cluster  # noqa: E402: after what it needs

# Debian's versions of these packages warn of each other.
pytestmark = pytest.mark.filterwarnings("default")

PLAN = """format = "oblique-ensemble/1"
diagram = "oscillator.toml"
[vary]
"x.initial" = "1..2:100"
"v.in[1]" = [-1, -2]
[measure]
last = "end(x)"
largest = "max(x)"
"""
CHUNKS = 20
# An oscillator of some fifty turns: a chunk takes so long that what is killed is in the middle of one.
SLOW = """format = "oblique-diagram/1"
[run]
until = 300
tolerance = 1e-10
[blocks]
x = { type = "integrator", in = ["v"], initial = 1 }
v = { type = "integrator", in = ["-x"] }
"""


@pytest.fixture
def plan(tmp_path):
    (tmp_path / "oscillator.toml").write_text(SLOW, encoding="utf-8")
    (tmp_path / "plan.toml").write_text(PLAN, encoding="utf-8")
    return ob.Plan(tmp_path / "plan.toml", threads=1)


class Cluster:
    """A scheduler and two workers, processes that can be killed."""

    def __init__(self, logs):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self._log = open(logs / "log", "w", encoding="utf-8")
        self.scheduler = self._start_scheduler()
        self.workers = [self._start_worker() for _ in range(2)]

    def _start(self, *arguments):
        environment = {**os.environ, "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "20s"}
        return subprocess.Popen([sys.executable, "-m", *arguments], stdout=self._log, stderr=self._log, env=environment,
                                start_new_session=True)

    def _start_scheduler(self):
        return self._start("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", str(self.port),
                           "--no-dashboard", "--no-show")

    def _start_worker(self):
        return self._start("distributed.cli.dask_worker", self.address, "--nthreads", "1", "--no-nanny",
                           "--no-dashboard", "--death-timeout", "30")

    def kill_worker(self):
        """As a computer that is switched off; another one comes in its place."""
        self._kill(self.workers.pop(0))
        self.workers.append(self._start_worker())

    def kill_scheduler(self):
        """And what keeps it running starts it again, with workers, which end with their scheduler."""
        self._kill(self.scheduler)
        for worker in self.workers:
            self._kill(worker)
        self.scheduler = self._start_scheduler()
        self.workers = [self._start_worker() for _ in range(2)]

    def _kill(self, process):
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()

    def close(self):
        for process in (*self.workers, self.scheduler):
            if process.poll() is None:
                self._kill(process)
        self._log.close()


@pytest.fixture
def cluster(tmp_path):
    made = Cluster(tmp_path)
    try:
        yield made
    finally:
        made.close()


def test_what_is_killed_changes_no_byte(plan, cluster, tmp_path):
    serial = plan.run()
    # In memory, while a worker is killed.
    seen = []

    def kill_a_worker(done, chunks):
        seen.append(done)
        if len(seen) == 3:
            cluster.kill_worker()

    run = on_cluster.run(plan, cluster.address, chunks=CHUNKS, batch=6, progress=kill_a_worker)
    assert run.rows.tobytes() == serial.rows.tobytes()
    assert seen[-1] == CHUNKS and run.failures == {} and run.varied == serial.varied

    # As files, by a client of one's own, while the scheduler is killed and started again.
    killed = threading.Event()

    def kill_the_scheduler(done, _):
        if done >= 5 and not killed.is_set():
            killed.set()
            cluster.kill_scheduler()

    with distributed.Client(cluster.address, timeout=20) as client:
        run = on_cluster.run(plan, client, chunks=CHUNKS, batch=4, folder=tmp_path / "c", progress=kill_the_scheduler)
        assert killed.is_set()
        assert run.rows.tobytes() == serial.rows.tobytes()
        assert len(list((tmp_path / "c").iterdir())) == CHUNKS
        # What is there is not run again, and what is damaged is.
        asked = []
        broken = sorted((tmp_path / "c").iterdir())[3]
        broken.write_bytes(broken.read_bytes()[:100])
        again = on_cluster.run(plan, cluster.address, chunks=CHUNKS, folder=tmp_path / "c",
                               progress=lambda *both: asked.append(both))
        assert asked == [(CHUNKS, CHUNKS)] and again.rows.tobytes() == serial.rows.tobytes()

        # What does not belong there is told of before the work, not after it.
        ob.Plan(text=PLAN.replace("1..2", "1..3"), file=plan._file).make_chunk(0, CHUNKS, tmp_path / "other")
        with pytest.raises(ob.PlanError, match="this chunk is of another plan"):
            on_cluster.run(plan, client, folder=tmp_path / "other", progress=lambda *_: pytest.fail("it runs"))

        # Ctrl-C, after some chunks: what is done is there, in memory and as files.
        def stop(done, _):
            if done >= 3:
                raise KeyboardInterrupt

        for folder in (None, tmp_path / "stopped"):
            with pytest.raises(ob.Interrupted, match="of 200 machines were run") as stopped:
                on_cluster.run(plan, client, chunks=CHUNKS, batch=2, folder=folder, progress=stop)
            part = stopped.value.run
            assert 30 <= len(part.rows) < 200 and part.rows.tobytes() == serial.rows[part.numbers].tobytes()
        assert len(list(folder.iterdir())) * 10 == len(part.rows) and "called again" in str(stopped.value)

        # A chunk that takes too long, and one that cannot be had.
        with pytest.raises(ob.PlanError, match=r"failed 2 times: it took longer than 1e-09 s"):
            on_cluster.run(plan, cluster.address, chunks=CHUNKS, retries=1, time_limit=1e-9)


def test_what_makes_no_sense_is_refused(plan):
    with pytest.raises(ob.RequestError, match="client=3 is no client"):
        on_cluster.run(plan, 3)
    with pytest.raises(ob.PlanError, match="no scheduler of Dask answers at tcp://127.0.0.1:9"):
        on_cluster.run(plan, "tcp://127.0.0.1:9", patience=0.2)
    for wrong in ({"chunks": 0}, {"chunks": 1.5}, {"batch": 0}, {"retries": -1}, {"time_limit": 0}, {"patience": 0}):
        with pytest.raises(ob.RequestError):
            on_cluster.run(plan, "tcp://127.0.0.1:9", **wrong)
    with pytest.raises(ob.PlanError, match="is not cut into 201 chunks"):
        on_cluster.run(plan, "tcp://127.0.0.1:9", chunks=201)


def test_a_worker_with_something_else_says_so(plan, tmp_path):
    parts = (PLAN.replace("1..2", "1..3"), str(tmp_path / "plan.toml"), SLOW.encode(), ())
    with pytest.raises(ob.PlanError, match="the worker has another diagram, plan, files or blocks"):
        on_cluster._make(parts, plan._raw.identity, 0, 1, None)
    with pytest.raises(ob.PlanError, match="the worker has another version of Oblique"):
        on_cluster._make((PLAN, *parts[1:]), ("0.0.7", *plan._raw.identity[1:]), 0, 1, None)
