"""`cusp orient` on several worker processes or machines, by Dask: the same models and options, and the same answer."""

from __future__ import annotations

import argparse
import hashlib
import logging
import signal
import sys
import uuid
from collections.abc import Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from pathlib import Path
from subprocess import DEVNULL, PIPE, CompletedProcess, Popen, run
from tempfile import TemporaryDirectory
from threading import Lock
from typing import cast

import dask
from distributed import Client, Future, KilledWorker, LocalCluster, Worker, WorkerPlugin, as_completed, get_worker

# How often a task is retried when cusp itself was killed, for lack of memory, for example.
RETRIES = 2
# Options of cusp that name files; workers may not have them.
FILE_OPTIONS = ("--weights", "--resin")


class Workplace(WorkerPlugin):
    """On every worker, including later ones: files and the processes that read them, removed at the end."""

    def __init__(self, cusp: str, file_options: list[str], options: list[str]) -> None:
        self.cusp, self.file_options, self.options = cusp, file_options, options

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

    def measure(self, shard: str, names: list[str], contents: list[bytes]) -> CompletedProcess[str]:
        """Runs cusp on a model. `contents` holds the model first, then the files of options, in their order."""
        model, *files = places = [self.place(content) for content in contents]
        options = [f"{option}={file}" for option, file in zip(self.file_options, files)] + self.options
        command = [self.cusp, "orient", model, *options, f"--shard={shard}"]
        try:
            with self.lock:
                # A retried task may begin during shutdown.
                if self.is_closed:
                    raise ChildProcessError(f"the search on {self.address} has ended")
                process = Popen(command, stdin=DEVNULL, stdout=PIPE, stderr=PIPE, encoding="utf-8")
                self.running.add(process)
        except ChildProcessError:
            raise
        except OSError as error:
            raise OSError(f"{self.cusp} on {self.address}: {error.strerror}; name the program by --cusp") from error
        line, message = process.communicate()
        with self.lock:
            self.running.discard(process)
        if process.returncode < 0:
            raise ChildProcessError(f"{self.cusp} on {self.address} was ended by signal {-process.returncode}")
        for place, name in zip(places, names):
            message = message.replace(place, name)
        return CompletedProcess(command, process.returncode, line, message)


def measure(workplace: str, shard: str, names: list[str], contents: list[bytes]) -> CompletedProcess[str]:
    """The task: one shard of one model."""
    return cast(Workplace, get_worker().plugins[workplace]).measure(shard, names, contents)


def send(client: Client, content: bytes) -> Future[bytes]:
    """Sends a file to the workers as a task, whose result is recomputed when the workers that hold it are lost."""
    return client.submit(bytes, content, key=f"cusp-{hashlib.sha256(content).hexdigest()}")


class Given:
    """The user's input: files of options, and models by content, which is how cusp identifies them.

    A model given twice is measured once, since cusp takes a shard only once. An unreadable file is left out: cusp
    reports it in the end.
    """

    def __init__(self, arguments: argparse.Namespace) -> None:
        self.models: dict[bytes, list[str]] = {}
        self.files: list[bytes] = []
        try:
            self.files = [Path(file).read_bytes() for file in arguments.files.values()]
        except OSError:
            return
        for path in arguments.models:
            with suppress(OSError):
                self.models.setdefault(Path(path).read_bytes(), []).append(path)


class Stop(Exception):
    """The search fails for all models: the exit code and message of cusp."""

    def __init__(self, code: int, message: str) -> None:
        super().__init__(message)
        self.code, self.message = code, message


class Measured:
    """The results for the models, identified by their content."""

    def __init__(self) -> None:
        # cusp's messages about models that it could not measure.
        self.refused: dict[bytes, str] = {}
        # Why cusp gave no answer at all.
        self.lost: dict[bytes, str] = {}

    def is_bad(self, model: bytes) -> bool:
        return model in self.refused or model in self.lost

    def take(self, model: bytes, task: Future[CompletedProcess[str]]) -> str:
        """The part that a finished task measured; empty if it failed."""
        try:
            part = task.result()
        except (ChildProcessError, KilledWorker) as error:
            self.lost[model] = str(error)
            return ""
        if part.returncode == 1:
            self.refused[model] = part.stderr
        elif part.returncode != 0:
            raise Stop(part.returncode, part.stderr)
        return part.stdout


def measure_all(client: Client, arguments: argparse.Namespace, given: Given, parts: Path) -> Measured:
    """Measures all shards of all models and writes them to `parts`."""
    measured = Measured()
    workplace = f"cusp-{uuid.uuid4()}"
    client.register_plugin(Workplace(arguments.cusp, list(arguments.files), arguments.options), name=workplace)
    try:
        count = arguments.shards or 2 * sum(client.nthreads().values())
        files = [send(client, content) for content in given.files]
        tasks: dict[Future[CompletedProcess[str]], bytes] = {}
        for model, paths in given.models.items():
            names, contents = [paths[0], *arguments.files.values()], [send(client, model), *files]
            for shard in (f"{number}/{count}" for number in range(1, count + 1)):
                task = client.submit(measure, workplace, shard, names, contents, retries=RETRIES, pure=False)
                tasks[task] = model
        with parts.open("w", encoding="utf-8") as file:
            for done, task in enumerate(as_completed(tasks), 1):
                model = tasks[task]
                if not measured.is_bad(model):
                    file.write(measured.take(model, task))
                    if measured.is_bad(model):
                        client.cancel([other for other in tasks if tasks[other] == model])
                if sys.stderr.isatty():
                    end = "\n" if done == len(tasks) else "\r"
                    print(f"measured {done} of {len(tasks)} shards", end=end, file=sys.stderr, flush=True)
        return measured
    finally:
        # Also ends processes that still run after an error or an interrupt.
        client.unregister_worker_plugin(workplace)


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


def parse() -> argparse.Namespace:
    """This script's own arguments; those for cusp are its `options` and `files`."""
    usage = "%(prog)s [--workers N | --scheduler ADDRESS] [--shards N] [--cusp PATH] MODEL... [OPTION...]"
    parser = argparse.ArgumentParser(description=__doc__, usage=usage, allow_abbrev=False)
    parser.add_argument("models", metavar="MODEL", nargs="+", help="STL files, before the options of cusp orient")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--workers", metavar="N", type=count_of, default=4, help="processes on this machine [4]")
    where.add_argument("--scheduler", metavar="ADDRESS", help="an existing Dask scheduler: tcp://HOST:8786")
    parser.add_argument("--shards", metavar="N", type=count_of, help="parts of a search [2 per worker]")
    parser.add_argument("--cusp", metavar="PATH", default="cusp", help="the program, here and on workers [cusp]")
    for option in FILE_OPTIONS:
        parser.add_argument(option, metavar="FILE", help="as for cusp orient; the file is sent to the workers")
    arguments, options = parser.parse_known_args()
    arguments.options = options
    arguments.files = {option: file for option in FILE_OPTIONS if (file := getattr(arguments, option.strip("-")))}
    return arguments


def search(arguments: argparse.Namespace) -> int:
    """Measures on the workers and merges here; returns an exit code."""
    given, measured = Given(arguments), Measured()
    with TemporaryDirectory(prefix="cusp-orient-") as folder:
        parts = Path(folder, "parts.jsonl")
        parts.touch()
        if given.models:
            with connect(arguments, folder) as client:
                measured = measure_all(client, arguments, given, parts)
        lost = {path: reason for model, reason in measured.lost.items() for path in given.models[model]}
        for path, reason in lost.items():
            print(f"orient.py: {path}: {reason}", file=sys.stderr)
        models = [path for path in arguments.models if path not in lost]
        if not models:
            return 1
        files = [f"{option}={file}" for option, file in arguments.files.items()]
        command = [arguments.cusp, "orient", *models, *files, *arguments.options, f"--merge={parts}"]
        merged = run(command, stdin=DEVNULL, stderr=PIPE if measured.refused else None, encoding="utf-8")
        # Merging reports the same failures in the order of the models; the rest are failures of a worker.
        words = merged.stderr or ""
        sys.stderr.write(words)
        sys.stderr.writelines(message for message in measured.refused.values() if message not in words)
        return merged.returncode or bool(lost)


def main() -> int:
    # SIGTERM ends the search as Ctrl-C does, and leaves nothing behind.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    dask.config.set({
        # A task that kills more workers is given up. (An existing scheduler has its own limit.)
        "distributed.scheduler.allowed-failures": 3,
        # Models are sent as tasks, which Dask would warn about from 10 MB.
        "distributed.admin.large-graph-warning-threshold": "1 TiB",
    })
    try:
        return search(parse())
    except KeyboardInterrupt:
        return 130
    except Stop as stop:
        sys.stderr.write(stop.message)
        return stop.code
    except OSError as error:
        message = f"{error.filename}: {error.strerror}" if error.filename else str(error)
    except (KilledWorker, CancelledError) as error:
        message = str(error)
    print(f"orient.py: {message}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
