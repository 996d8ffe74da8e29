"""What the tests of both examples share."""

from __future__ import annotations

import logging
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil
from distributed import Client, LocalCluster

CUSP = os.environ.get("CUSP") or shutil.which("cusp") or "cusp"
# Seconds to wait before giving up.
PATIENCE = 100

# A cusp that numbers its calls and holds those after the first few until a file `release` exists. It also records its
# own process and its caller's.
HOLDING_CUSP = """#!/bin/sh
number=1
until mkdir '{calls}'/$number 2>/dev/null; do number=$((number + 1)); done
printf '%s\\n' "$@" > '{calls}'/$number/arguments
if [ $number -gt {free} ]; then
    echo $PPID $$ > '{calls}'/$number/new
    mv '{calls}'/$number/new '{calls}'/$number/held
    while [ -d '{calls}' ] && [ ! -e '{calls}'/release ]; do sleep 0.05; done
fi
exec '{cusp}' "$@"
"""

Point = tuple[float, float]


def write_frustum(path: Path, base: list[Point], top: list[Point], height: float) -> None:
    """A binary STL of a solid between two polygons with the same number of corners."""
    low = [(x, y, 0.0) for x, y in base]
    high = [(x, y, height) for x, y in top]
    facets = []
    for i in range(len(base)):
        j = (i + 1) % len(base)
        facets += [(low[i], low[j], high[j]), (low[i], high[j], high[i])]
    for i in range(1, len(base) - 1):
        facets += [(low[0], low[i + 1], low[i]), (high[0], high[i], high[i + 1])]
    with path.open("wb") as file:
        file.write(bytes(80) + struct.pack("<I", len(facets)))
        for facet in facets:
            corners = [length for corner in facet for length in corner]
            file.write(struct.pack("<12fH", 0, 0, 0, *corners, 0))


def wait_until(happened: Callable[[], bool], what: str) -> None:
    end = time.monotonic() + PATIENCE
    while not happened():
        if time.monotonic() > end:
            raise AssertionError(f"waited in vain: {what}")
        time.sleep(0.05)


def processes_of(session: int) -> list[psutil.Process]:
    """The processes of a session that still run."""
    found = []
    for process in psutil.process_iter():
        try:
            if os.getsid(process.pid) == session and process.status() != psutil.STATUS_ZOMBIE:
                found.append(process)
        except (ProcessLookupError, psutil.NoSuchProcess):
            continue
    return found


@contextmanager
def usual_interrupts() -> Iterator[None]:
    """Programs started in this context can be interrupted, as on a terminal.

    A shell has jobs in the background ignore interrupts, and so all that they start, these tests for instance.
    """
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@unittest.skipUnless(os.name == "posix", "needs signals and a shell")
class Example(unittest.TestCase):
    """A test of one of the examples: models, and the example in processes of its own."""

    PROGRAM: str

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="cusp-cluster-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()
        self.calls = self.folder / "calls"
        self.calls.mkdir()
        self.wedge = self.folder / "wedge.stl"
        self.spire = self.folder / "spire.stl"
        write_frustum(self.wedge, [(0, 0), (8, 0), (8, 5), (0, 5)], [(0, 0), (5, 0), (5, 5), (0, 5)], 6)
        write_frustum(self.spire, [(0, 0), (6, 0), (0, 4)], [(1, 1), (2, 1), (1, 2)], 7)

    def script(self, name: str, text: str) -> Path:
        path = self.folder / name
        path.write_text(text)
        path.chmod(0o755)
        return path

    def holding_cusp(self, free: int) -> Path:
        """See `HOLDING_CUSP`."""
        path = self.script("holding-cusp", HOLDING_CUSP.format(calls=self.calls, free=free, cusp=Path(CUSP).absolute()))
        # Whatever happens, no call is held forever.
        self.addCleanup(self.release)
        return path

    def release(self) -> None:
        (self.calls / "release").touch()

    def start(self, *arguments: str | Path) -> subprocess.Popen[str]:
        """Starts the example in its own session and with its own temporary folder."""
        with usual_interrupts():
            example = subprocess.Popen(
                [sys.executable, Path(__file__).with_name(self.PROGRAM), *arguments],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                start_new_session=True,
                env={**os.environ, "TMPDIR": str(self.temporary)},
            )
        self.addCleanup(self.end, example)
        return example

    def end(self, example: subprocess.Popen[str]) -> None:
        for process in processes_of(example.pid):
            process.kill()
        example.communicate()

    def finish(self, example: subprocess.Popen[str]) -> tuple[int, str, str]:
        """Returns exit code, output and messages once it ends, leaving no process or file behind."""
        output, messages = example.communicate(timeout=PATIENCE)
        wait_until(lambda: not processes_of(example.pid), "processes end with the example")
        self.assertEqual(list(self.temporary.iterdir()), [])
        return example.returncode, output, messages

    def kill_a_worker(self, client: Client, example: subprocess.Popen[str], held: Path) -> None:
        """Kills the worker whose cusp waits, and that cusp, as if the machine were lost; then lets the others go on."""
        wait_until(lambda: held.exists() or example.poll() is not None, "a worker is halfway")
        self.assertIsNone(example.poll(), "the example ended before a worker was killed")
        worker, its_cusp = map(int, held.read_text().split())
        addresses = {pid: address for address, pid in client.run(os.getpid).items()}
        address = addresses[worker]
        self.assertEqual(len(addresses), 2)
        self.assertTrue(client.processing()[address], "the worker has no task")
        os.kill(worker, signal.SIGKILL)
        os.kill(its_cusp, signal.SIGKILL)
        wait_until(lambda: address not in client.nthreads(), "the scheduler misses the worker")
        wait_until(lambda: not psutil.pid_exists(worker), "the worker is gone")
        self.release()

    @contextmanager
    def cluster(self) -> Iterator[tuple[Client, LocalCluster]]:
        """Two workers, one of which will be killed."""
        cluster = LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            host="127.0.0.1",
            dashboard_address=None,
            local_directory=str(self.folder),
            # The test loses a worker on purpose.
            silence_logs=logging.CRITICAL,
        )
        with cluster, Client(cluster) as client:
            self.addCleanup(self.release)
            yield client, cluster
