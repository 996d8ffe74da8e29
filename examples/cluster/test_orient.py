"""Runs the example for real: worker processes on this machine, one of them killed halfway.

    CUSP=target/release/cusp python -m unittest -v examples/cluster/test_orient.py
"""

from __future__ import annotations

import json
import logging
import os
import re
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

EXAMPLE = Path(__file__).with_name("orient.py")
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

# A cusp that is killed whenever it measures a model of this many bytes.
DYING_CUSP = """#!/bin/sh
case "$*" in
    *--shard=*) [ "$(wc -c < "$2")" -eq {bytes} ] && kill -KILL $$ ;;
esac
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
class Orient(unittest.TestCase):
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
        self.options: list[str | Path] = ["--directions=60", "--alpha=0.3", "--json"]

    def cusp(self, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run([CUSP, "orient", *arguments], capture_output=True, text=True, timeout=PATIENCE)

    def in_one_process(self, *arguments: str | Path) -> str:
        """The expected answer; the command must succeed."""
        found = self.cusp(*arguments)
        self.assertEqual(found.returncode, 0, found.stderr)
        for line in found.stdout.splitlines():
            self.assertGreater(len(json.loads(line)["best"]), 0)
        return found.stdout

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
                [sys.executable, EXAMPLE, *arguments],
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

    def call(self, number: int) -> list[str]:
        """The arguments of a call of the holding cusp: the model's name and the shard."""
        _, model, *options = (self.calls / str(number) / "arguments").read_text().splitlines()
        return [Path(model).name, *(option for option in options if option.startswith("--shard="))]

    def test_a_batch_on_several_workers(self) -> None:
        resin = self.folder / "resin.json"
        resin.write_text('{"exposure_s": 1.5}')
        # A model given twice is measured once and answered twice.
        batch = [self.wedge, self.spire, self.wedge, *self.options, f"--resin={resin}"]
        code, output, messages = self.finish(self.start("--workers=3", f"--cusp={CUSP}", *batch))
        self.assertEqual((code, messages), (0, ""))
        self.assertEqual(output, self.in_one_process(*batch))

    def test_a_worker_is_killed_half_way(self) -> None:
        shards = 4
        batch = [self.wedge, self.spire, *self.options]
        half = shards * 2 // 2
        cusp = self.holding_cusp(free=half)
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
            arguments = [f"--scheduler={cluster.scheduler_address}", f"--cusp={cusp}", f"--shards={shards}", *batch]
            example = self.start(*arguments)
            # Half of the calls went through; the next one belongs to a worker that waits for it.
            held = self.calls / str(half + 1) / "held"
            wait_until(lambda: held.exists() or example.poll() is not None, "a worker is halfway")
            self.assertIsNone(example.poll(), "the example ended before a worker was killed")
            worker, its_cusp = map(int, held.read_text().split())
            addresses = {pid: address for address, pid in client.run(os.getpid).items()}
            address = addresses[worker]
            self.assertEqual(len(addresses), 2)
            self.assertTrue(client.processing()[address], "the worker has no task")

            os.kill(worker, signal.SIGKILL)
            # As if the machine were lost.
            os.kill(its_cusp, signal.SIGKILL)
            wait_until(lambda: address not in client.nthreads(), "the scheduler misses the worker")
            wait_until(lambda: not psutil.pid_exists(worker), "the worker is gone")
            self.release()
            code, output, messages = self.finish(example)
        self.assertEqual((code, messages), (0, ""))
        self.assertEqual(output, self.in_one_process(*batch))
        # The last call merges.
        *measured, _ = [self.call(number) for number in range(1, len(list(self.calls.iterdir())))]
        self.assertEqual(len({tuple(call) for call in measured}), 2 * shards)
        self.assertGreaterEqual(measured.count(self.call(half + 1)), 2, "what the worker had was not measured again")

    def test_an_interrupt_leaves_nothing(self) -> None:
        cusp = self.holding_cusp(free=0)
        # Ctrl-C reaches all processes of a terminal.
        for round, (interrupt, number) in enumerate([(os.kill, signal.SIGTERM), (os.killpg, signal.SIGINT)], 1):
            example = self.start("--workers=2", f"--cusp={cusp}", self.wedge, *self.options)
            wait_until(lambda: (self.calls / str(2 * round) / "held").exists(), "both workers measure")
            interrupt(example.pid, number)
            try:
                example.wait(timeout=PATIENCE / 4)
            except subprocess.TimeoutExpired:
                # Python drops an interrupt that arrives during garbage collection; a user would press it again.
                interrupt(example.pid, number)
            self.assertEqual(self.finish(example), (130, "", ""))

    def test_a_bad_model_does_not_stop_the_others(self) -> None:
        poem = self.folder / "poem.stl"
        poem.write_text("no model\n")
        absent = self.folder / "absent.stl"
        batch = [poem, self.wedge, absent, self.spire, poem, *self.options]
        native = self.cusp(*batch)
        # Two lines of answers, three of errors.
        good = self.in_one_process(self.wedge, self.spire, *self.options)
        self.assertEqual((native.stdout, native.stderr.count("\n")), (good, 3))
        found = self.finish(self.start("--workers=2", f"--cusp={CUSP}", *batch))
        self.assertEqual(found, (1, native.stdout, native.stderr))

    def test_a_model_that_cusp_dies_of_does_not_stop_the_others(self) -> None:
        cusp = self.script("dying-cusp", DYING_CUSP.format(bytes=self.spire.stat().st_size, cusp=Path(CUSP).absolute()))
        batch = [self.spire, self.wedge, *self.options]
        code, output, messages = self.finish(self.start("--workers=2", f"--cusp={cusp}", *batch))
        self.assertEqual((code, output), (1, self.in_one_process(self.wedge, *self.options)))
        death = f"{re.escape(str(cusp))} on tcp://[^ ]+ was ended by signal 9"
        self.assertRegex(messages, f"^orient.py: {re.escape(str(self.spire))}: {death}\n$")

    def test_what_is_wrong_for_every_model_is_said_once(self) -> None:
        for wrong in ["--layer-min=0.2", f"--weights={self.wedge}", f"--resin={self.folder}/absent.json"]:
            batch = [self.wedge, self.spire, *self.options, wrong]
            native = self.cusp(*batch)
            self.assertEqual((native.returncode, native.stdout, native.stderr.count("\n")), (1, "", 1))
            found = self.finish(self.start("--workers=2", f"--cusp={CUSP}", *batch))
            self.assertEqual(found, (1, "", native.stderr))

        missing = self.folder / "no-cusp"
        code, output, messages = self.finish(self.start("--workers=1", f"--cusp={missing}", self.wedge, self.spire))
        self.assertEqual((code, output, messages.count("\n")), (1, "", 1))
        self.assertIn("name the program by --cusp", messages)

    def test_errors_are_those_of_cusp(self) -> None:
        code, output, messages = self.finish(self.start("--workers=1", f"--cusp={CUSP}", self.wedge, "--alpha=7"))
        self.assertEqual((code, output, messages), (2, "", self.cusp(self.wedge, "--alpha=7").stderr))

        text = self.folder / "text.stl"
        text.write_text("no model\n")
        code, output, messages = self.finish(self.start("--workers=1", f"--cusp={CUSP}", text, *self.options))
        self.assertEqual((code, output, messages), (1, "", self.cusp(text, *self.options).stderr))
        # The message names the given file, not a worker's copy.
        self.assertIn(str(text), messages)

    def test_merging_notices_gaps_and_duplicates(self) -> None:
        parts = []
        for number in range(1, 4):
            part = self.cusp(self.wedge, *self.options, f"--shard={number}/3")
            self.assertEqual(part.returncode, 0, part.stderr)
            path = self.folder / f"part-{number}.jsonl"
            path.write_text(part.stdout)
            parts.append(path)
        first, second, third = parts
        for given, message in [
            ([first, third], "is a shard missing?"),
            ([first, second, third, second], "was measured twice, in shards 2/3 and 2/3"),
        ]:
            merged = self.cusp(self.wedge, *self.options, "--merge", *given)
            self.assertEqual((merged.returncode, merged.stdout), (1, ""))
            self.assertIn(message, merged.stderr)
        merged = self.cusp(self.wedge, *self.options, "--merge", third, first, second)
        self.assertEqual(merged.stdout, self.in_one_process(self.wedge, *self.options))


if __name__ == "__main__":
    unittest.main()
