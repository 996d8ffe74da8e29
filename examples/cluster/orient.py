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
from contextlib import contextmanager
from pathlib import Path
from subprocess import DEVNULL, PIPE, CompletedProcess, Popen, run
from tempfile import TemporaryDirectory
from threading import Lock
from typing import cast

import dask
from distributed import Client, Future, KilledWorker, LocalCluster, Worker, WorkerPlugin, as_completed, get_worker

# How often a task is tried again when cusp itself was killed, for want of memory, say.
RETRIES = 2
# Options of cusp that name files, which workers may not have.
FILE_OPTIONS = ("--weights", "--resin")


class Workplace(WorkerPlugin):
    """On every worker, also later ones: a folder of files and the processes that read them, both gone at its end."""

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
        """Writes a file unless it is there."""
        path = Path(self.folder.name, hashlib.sha256(content).hexdigest())
        with self.lock:
            if path not in self.placed:
                path.write_bytes(content)
                self.placed.add(path)
        return str(path)

    def measure(self, shard: str, names: list[str], contents: list[bytes]) -> CompletedProcess[str]:
        """Runs cusp on a model, which comes first, with the files of options, in their order."""
        model, *files = places = [self.place(content) for content in contents]
        options = [f"{option}={file}" for option, file in zip(self.file_options, files)] + self.options
        command = [self.cusp, "orient", model, *options, f"--shard={shard}"]
        try:
            with self.lock:
                # A task that is tried again may begin while all of them end.
                if self.is_closed:
                    raise ChildProcessError(f"the search on {self.address} has ended")
                process = Popen(command, stdin=DEVNULL, stdout=PIPE, stderr=PIPE, encoding="utf-8")
                self.running.add(process)
        except OSError as error:
            message = f"orient.py: {self.cusp} on {self.address}: {error.strerror}; name the program by --cusp\n"
            return CompletedProcess(command, 1, "", message)
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
    """Puts a file where tasks find it: as a task, whose result is made again when the workers that have it go."""
    return client.submit(bytes, content, key=f"cusp-{hashlib.sha256(content).hexdigest()}")


def measure_all(client: Client, arguments: argparse.Namespace, parts: Path) -> int:
    """Measures all shards of all models, writes them to `parts`, and returns an exit code."""
    workplace = f"cusp-{uuid.uuid4()}"
    client.register_plugin(Workplace(arguments.cusp, list(arguments.files), arguments.options), name=workplace)
    try:
        count = arguments.shards or 2 * sum(client.nthreads().values())
        files = [send(client, Path(file).read_bytes()) for file in arguments.files.values()]
        tasks = []
        for content, model in arguments.contents.items():
            names, contents = [model, *arguments.files.values()], [send(client, content), *files]
            for shard in (f"{number}/{count}" for number in range(1, count + 1)):
                tasks.append(client.submit(measure, workplace, shard, names, contents, retries=RETRIES, pure=False))
        with parts.open("w", encoding="utf-8") as file:
            for done, task in enumerate(as_completed(tasks), 1):
                part: CompletedProcess[str] = task.result()
                if part.returncode != 0:
                    sys.stderr.write(part.stderr)
                    return part.returncode
                file.write(part.stdout)
                if sys.stderr.isatty():
                    end = "\n" if done == len(tasks) else "\r"
                    print(f"measured {done} of {len(tasks)} shards", end=end, file=sys.stderr, flush=True)
        return 0
    finally:
        # Also ends what still runs after an error or an interrupt.
        client.unregister_worker_plugin(workplace)


@contextmanager
def connect(arguments: argparse.Namespace, folder: str) -> Iterator[Client]:
    """The workers: those of an existing scheduler, or processes on this machine that keep their files in `folder`."""
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
        # What matters of failed tasks is said here, without their tracebacks.
        silence_logs=logging.CRITICAL,
        # Ctrl-C reaches all processes of a terminal, and this one ends the others.
        preload=["import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"],
    )
    with cluster, Client(cluster) as client:
        yield client


def count_of(text: str) -> int:
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError("a number from 1 on is needed")
    return int(text)


def parse() -> argparse.Namespace:
    """This script's own arguments; those for cusp are its `options` and `files`."""
    usage = "%(prog)s [--workers N | --scheduler ADDRESS] [--shards N] [--cusp PATH] MODEL... [OPTION...]"
    parser = argparse.ArgumentParser(description=__doc__, usage=usage, allow_abbrev=False)
    parser.add_argument("models", metavar="MODEL", nargs="+", help="STL files, before all options of cusp orient")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--workers", metavar="N", type=count_of, default=4, help="processes on this machine [4]")
    where.add_argument("--scheduler", metavar="ADDRESS", help="an existing Dask scheduler: tcp://HOST:8786")
    parser.add_argument("--shards", metavar="N", type=count_of, help="parts of a search [2 for each worker]")
    parser.add_argument("--cusp", metavar="PATH", default="cusp", help="the program, here and on workers [cusp]")
    for option in FILE_OPTIONS:
        parser.add_argument(option, metavar="FILE", help="as for cusp orient: workers are sent the file")
    arguments, options = parser.parse_known_args()
    arguments.options = options
    arguments.files = {option: file for option in FILE_OPTIONS if (file := getattr(arguments, option.strip("-")))}
    return arguments


def search(arguments: argparse.Namespace) -> int:
    """Measures on the workers and merges here; returns an exit code."""
    # A model that is given twice is measured once: cusp knows models by their content, and takes a shard only once.
    arguments.contents = {Path(model).read_bytes(): model for model in arguments.models}
    with TemporaryDirectory(prefix="cusp-orient-") as folder:
        parts = Path(folder, "parts.jsonl")
        with connect(arguments, folder) as client:
            code = measure_all(client, arguments, parts)
        files = [f"{option}={file}" for option, file in arguments.files.items()]
        command = [arguments.cusp, "orient", *arguments.models, *files, *arguments.options, f"--merge={parts}"]
        return code or run(command, stdin=DEVNULL).returncode


def main() -> int:
    # Ends like Ctrl-C, and so leaves nothing behind.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    dask.config.set({
        # A task that takes more workers with it is given up. (An existing scheduler has its own limit.)
        "distributed.scheduler.allowed-failures": 3,
        # Models are sent as tasks; from 10 MB on there would be a warning.
        "distributed.admin.large-graph-warning-threshold": "1 TiB",
    })
    try:
        return search(parse())
    except KeyboardInterrupt:
        return 130
    except OSError as error:
        message = f"{error.filename}: {error.strerror}" if error.filename else str(error)
    except (KilledWorker, CancelledError) as error:
        message = str(error)
    print(f"orient.py: {message}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
