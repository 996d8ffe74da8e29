"""What both examples share: running `cusp` on the workers of a Dask cluster, with files that they need not have."""

from __future__ import annotations

import argparse
import hashlib
import logging
import signal
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager
from pathlib import Path
from subprocess import DEVNULL, PIPE, CompletedProcess, Popen
from tempfile import TemporaryDirectory
from threading import Lock
from typing import cast

import cloudpickle
import dask
from distributed import Client, Future, KilledWorker, LocalCluster, Worker, WorkerPlugin, get_worker

# Workers elsewhere do not have this module: it is sent with what is run there.
cloudpickle.register_pickle_by_value(sys.modules[__name__])

# How often a task is retried when cusp itself was killed, for lack of memory, for example.
RETRIES = 2
# Options of cusp that name files; workers may not have them.
FILE_OPTIONS = ("--config", "--weights", "--resin")


class Workplace(WorkerPlugin):
    """On every worker, including later ones: files and the processes that read them, removed at the end."""

    def __init__(self, cusp: str) -> None:
        self.cusp = cusp

    def setup(self, worker: Worker) -> None:
        self.address = worker.address
        self.folder = TemporaryDirectory(prefix="cusp-", dir=worker.local_directory)
        self.placed: set[Path] = set()
        self.running: set[Popen[str]] = set()
        self.is_closed = False
        # A worker may have several threads, each with a task.
        self.lock = Lock()

    def teardown(self, worker: Worker) -> None:
        with self.lock:
            self.is_closed = True
            for process in self.running:
                process.kill()
        self.folder.cleanup()

    def place(self, content: bytes) -> str:
        """Writes a file unless it exists."""
        path = Path(self.folder.name, hashlib.sha256(content).hexdigest())
        with self.lock:
            if path not in self.placed:
                path.write_bytes(content)
                self.placed.add(path)
        return str(path)

    def call(self, arguments: list[str], names: dict[str, str]) -> CompletedProcess[str]:
        """Runs cusp. In its messages, `names` takes the place of the places of files."""
        command = [self.cusp, *arguments]
        try:
            with self.lock:
                # A retried task may begin during shutdown.
                if self.is_closed:
                    raise ChildProcessError(f"the work on {self.address} has ended")
                process = Popen(command, stdin=DEVNULL, stdout=PIPE, stderr=PIPE, encoding="utf-8")
                self.running.add(process)
        except ChildProcessError:
            raise
        except OSError as error:
            raise OSError(f"{self.cusp} on {self.address}: {error.strerror}; name the program by --cusp") from error
        answer, message = process.communicate()
        with self.lock:
            self.running.discard(process)
        if process.returncode < 0:
            raise ChildProcessError(f"{self.cusp} on {self.address} was ended by signal {-process.returncode}")
        for place, name in names.items():
            message = message.replace(place, name)
        return CompletedProcess(command, process.returncode, answer, message)


def workplace_of(name: str) -> Workplace:
    """Within a task: the workplace of its worker."""
    return cast(Workplace, get_worker().plugins[name])


def send(client: Client, content: bytes) -> Future[bytes]:
    """Sends a file to the workers as a task, whose result is recomputed when the workers that hold it are lost."""
    return client.submit(bytes, content, key=f"cusp-{hashlib.sha256(content).hexdigest()}")


class Stop(Exception):
    """The work fails for all models: the exit code and message of cusp."""

    def __init__(self, code: int, message: str) -> None:
        super().__init__(message)
        self.code, self.message = code, message


@contextmanager
def connect(arguments: argparse.Namespace, folder: str) -> Iterator[Client]:
    """Connects to an existing scheduler, or starts workers on this machine that keep their files in `folder`."""
    if arguments.scheduler:
        with Client(arguments.scheduler) as client:
            client.wait_for_workers(1, timeout=60)
            yield client
        return
    dask.config.set({"temporary-directory": folder})
    cluster = LocalCluster(
        n_workers=arguments.workers,
        threads_per_worker=1,
        host="127.0.0.1",
        dashboard_address=None,
        # Failed tasks are reported here, without their tracebacks.
        silence_logs=logging.CRITICAL,
        # Ctrl-C reaches all processes of a terminal; this one ends the others.
        preload=["import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"],
    )
    with cluster, Client(cluster) as client:
        yield client


def count_of(text: str) -> int:
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError("expected a positive whole number")
    return int(text)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of both examples; those for cusp are its `options` and `files`, see `parse_known`."""
    parser.add_argument("models", metavar="MODEL", nargs="+", help="models, before the options of cusp")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--workers", metavar="N", type=count_of, default=4, help="processes on this machine [4]")
    where.add_argument("--scheduler", metavar="ADDRESS", help="an existing Dask scheduler: tcp://HOST:8786")
    parser.add_argument("--cusp", metavar="PATH", default="cusp", help="the program, here and on workers [cusp]")
    for option in FILE_OPTIONS:
        parser.add_argument(option, metavar="FILE", help="as for cusp; the file is sent to the workers")


def parse_known(parser: argparse.ArgumentParser) -> argparse.Namespace:
    """Everything that is not known is for cusp."""
    arguments, options = parser.parse_known_args()
    arguments.options = options
    arguments.files = {option: file for option in FILE_OPTIONS if (file := getattr(arguments, option.strip("-")))}
    return arguments


def exit_code_of(name: str, work: Callable[[], int]) -> int:
    """Does the work of the example of this name, and tells what went wrong."""
    # SIGTERM ends the work as Ctrl-C does, and leaves nothing behind.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    dask.config.set({
        # A task that kills more workers is given up. (An existing scheduler has its own limit.)
        "distributed.scheduler.allowed-failures": 3,
        # Models are sent as tasks, which Dask would warn about from 10 MB.
        "distributed.admin.large-graph-warning-threshold": "1 TiB",
    })
    try:
        return work()
    except KeyboardInterrupt:
        return 130
    except Stop as stop:
        sys.stderr.write(stop.message)
        return stop.code
    except OSError as error:
        message = f"{error.filename}: {error.strerror}" if error.filename else str(error)
    except (KilledWorker, CancelledError) as error:
        message = str(error)
    print(f"{name}: {message}", file=sys.stderr)
    return 1
