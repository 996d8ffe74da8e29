"""`cusp orient` on several worker processes or machines, by Dask: the same models and options, and the same answer."""

from __future__ import annotations

import argparse
import sys
import uuid
from contextlib import suppress
from pathlib import Path
from subprocess import DEVNULL, PIPE, CompletedProcess, run
from tempfile import TemporaryDirectory

from distributed import Client, Future, KilledWorker, as_completed

from workers import RETRIES, Stop, Workplace, add_arguments, connect, count_of, exit_code_of, parse_known, send, workplace_of


def measure(workplace: str, shard: str, names: list[str], contents: list[bytes], file_options: list[str], options: list[str]) -> CompletedProcess[str]:
    """The task: one shard of one model. `contents` holds the model first, then the files of options, in their order."""
    here = workplace_of(workplace)
    model, *files = places = [here.place(content) for content in contents]
    given = [f"{option}={file}" for option, file in zip(file_options, files)] + options
    return here.call(["orient", model, *given, f"--shard={shard}"], dict(zip(places, names)))


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
            return ""
        if part.returncode != 0:
            raise Stop(part.returncode, part.stderr)
        return part.stdout


def measure_all(client: Client, arguments: argparse.Namespace, given: Given, parts: Path) -> Measured:
    """Measures all shards of all models and writes them to `parts`."""
    measured = Measured()
    workplace = f"cusp-{uuid.uuid4()}"
    client.register_plugin(Workplace(arguments.cusp), name=workplace)
    try:
        count = arguments.shards or 2 * sum(client.nthreads().values())
        files = [send(client, content) for content in given.files]
        tasks: dict[Future[CompletedProcess[str]], bytes] = {}
        for model, paths in given.models.items():
            names, contents = [paths[0], *arguments.files.values()], [send(client, model), *files]
            given_options = (list(arguments.files), arguments.options)
            for shard in (f"{number}/{count}" for number in range(1, count + 1)):
                task = client.submit(measure, workplace, shard, names, contents, *given_options, retries=RETRIES, pure=False)
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


def parse() -> argparse.Namespace:
    """This script's own arguments, and those for cusp."""
    usage = "%(prog)s [--workers N | --scheduler ADDRESS] [--shards N] [--cusp PATH] MODEL... [OPTION...]"
    parser = argparse.ArgumentParser(description=__doc__, usage=usage, allow_abbrev=False)
    add_arguments(parser)
    parser.add_argument("--shards", metavar="N", type=count_of, help="parts of a search [2 per worker]")
    return parse_known(parser)


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


if __name__ == "__main__":
    sys.exit(exit_code_of("orient.py", lambda: search(parse())))
