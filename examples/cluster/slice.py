"""`cusp slice` of many models on several worker processes or machines, by Dask: the same print files, and a line of JSON for each."""

from __future__ import annotations

import argparse
import json
import os
import sys
import uuid
from pathlib import Path
from subprocess import DEVNULL, CompletedProcess, run
from tempfile import NamedTemporaryFile, TemporaryDirectory
from typing import NamedTuple

from distributed import Client, Future, KilledWorker, as_completed

from workers import RETRIES, Stop, Workplace, add_arguments, connect, exit_code_of, parse_known, send, workplace_of


class Sliced(NamedTuple):
    """What a worker made of a model: cusp's line and messages, and the print file with its extension."""

    run: CompletedProcess[str]
    extension: str
    content: bytes


def slice_model(workplace: str, names: list[str], contents: list[bytes], file_options: list[str], options: list[str]) -> Sliced:
    """The task: one model. `contents` holds it first, then the files of options, in their order."""
    here = workplace_of(workplace)
    model, *files = places = [here.place(content) for content in contents]
    given = [f"{option}={file}" for option, file in zip(file_options, files)] + options
    with TemporaryDirectory(dir=here.folder.name) as folder:
        called = here.call(["slice", model, *given, "--json", "-o", folder + os.sep], dict(zip(places, names)))
        for file in Path(folder).iterdir():
            # A place has no dot.
            return Sliced(called, file.name.partition(".")[2], file.read_bytes())
    return Sliced(called, "", b"")


class Batch:
    """Where print files go, and what was said of their models."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self.models: list[str] = arguments.models
        self.folder = Path(arguments.output)
        self.failed: dict[str, str] = {}

    def check(self) -> None:
        """Refuses models whose print files would have one name, before any work."""
        if not self.folder.is_dir():
            raise Stop(1, f"slice.py: {self.folder}: there is no such folder; create it first\n")
        known: dict[str, str] = {}
        for model in self.models:
            other = known.setdefault(Path(model).stem.lower(), model)
            if other is not model:
                raise Stop(1, f"slice.py: {other} and {model} would both become {self.folder / Path(model).stem}; rename one\n")

    def write(self, model: str, sliced: Sliced) -> Path:
        """Writes a print file, either completely or not at all."""
        path = self.folder / f"{Path(model).stem}.{sliced.extension}"
        with NamedTemporaryFile(dir=self.folder, delete=False) as file:
            try:
                file.write(sliced.content)
                file.close()
                # As the umask has it; a temporary file is its owner's alone.
                mask = os.umask(0)
                os.umask(mask)
                os.chmod(file.name, 0o666 & ~mask)
                os.replace(file.name, path)
            except BaseException:
                Path(file.name).unlink(missing_ok=True)
                raise
        return path

    def take(self, model: str, task: Future[Sliced]) -> None:
        """Writes what a finished task made, and its line."""
        try:
            sliced = task.result()
        except (ChildProcessError, KilledWorker) as error:
            self.lose(model, str(error))
            return
        self.tell(model, sliced.run, sliced)

    def lose(self, model: str, reason: str) -> None:
        """Tells that there is no answer about a model."""
        message = f"slice.py: {model}: {reason}\n"
        sys.stderr.write(message)
        self.failed[model] = message
        self.print_line({"model": model, "error": {"code": "lost", "message": reason}})

    def tell(self, model: str, called: CompletedProcess[str], sliced: Sliced | None = None) -> None:
        """Tells what cusp said of a model."""
        line = json.loads(called.stdout) if called.stdout else {}
        if "model" not in line:
            # It is wrong for every model.
            raise Stop(called.returncode, called.stderr)
        sys.stderr.write(called.stderr)
        line["model"] = model
        line.pop("output", None)
        if called.returncode == 0 and sliced is not None:
            line["output"] = str(self.write(model, sliced))
        else:
            self.failed[model] = called.stderr
        self.print_line(line)

    @staticmethod
    def print_line(line: dict[str, object]) -> None:
        print(json.dumps(line, ensure_ascii=False, separators=(",", ":")), flush=True)

    def end(self) -> int:
        """Repeats what failed, in the order of the models; returns an exit code."""
        failed = [self.failed[model] for model in self.models if model in self.failed]
        if failed and len(self.models) > 1:
            print(f"slice.py: {len(failed)} of {len(self.models)} models failed:", file=sys.stderr)
            sys.stderr.writelines(failed)
        return int(bool(failed))


def slice_all(client: Client, arguments: argparse.Namespace, batch: Batch, contents: dict[str, bytes], files: list[bytes]) -> None:
    """Slices every model that could be read."""
    workplace = f"cusp-{uuid.uuid4()}"
    client.register_plugin(Workplace(arguments.cusp), name=workplace)
    try:
        sent = [send(client, content) for content in files]
        tasks: dict[Future[Sliced], str] = {}
        for model in list(contents):
            names = [model, *arguments.files.values()]
            given = [send(client, contents.pop(model)), *sent]
            task = client.submit(
                slice_model, workplace, names, given, list(arguments.files), arguments.options, retries=RETRIES, pure=False
            )
            tasks[task] = model
        count = len(tasks)
        for done, task in enumerate(as_completed(list(tasks)), 1):
            batch.take(tasks.pop(task), task)
            # Its print file is not needed any more, on no worker.
            task.release()
            if sys.stderr.isatty():
                print(f"sliced {done} of {count} models", end="\n" if done == count else "\r", file=sys.stderr, flush=True)
    finally:
        # Also ends processes that still run after an error or an interrupt.
        client.unregister_worker_plugin(workplace)


def parse() -> argparse.Namespace:
    """This script's own arguments, and those for cusp."""
    usage = "%(prog)s [--workers N | --scheduler ADDRESS] [--cusp PATH] MODEL... -o FOLDER [OPTION...]"
    parser = argparse.ArgumentParser(description=__doc__, usage=usage, allow_abbrev=False)
    add_arguments(parser)
    parser.add_argument("-o", "--output", metavar="FOLDER", required=True, help="where to write the print files, here")
    parser.add_argument("--json", action="store_true", help="as for cusp; lines are JSON without it as well")
    return parse_known(parser)


def work(arguments: argparse.Namespace) -> int:
    batch = Batch(arguments)
    batch.check()
    files = [Path(file).read_bytes() for file in arguments.files.values()]
    contents: dict[str, bytes] = {}
    unread: list[str] = []
    for model in batch.models:
        try:
            contents[model] = Path(model).read_bytes()
        except OSError:
            unread.append(model)
    options = [f"{option}={file}" for option, file in arguments.files.items()] + arguments.options
    for model in unread:
        # cusp says why.
        command = [arguments.cusp, "slice", model, *options, "--json", "-o", f"{batch.folder}{os.sep}"]
        batch.tell(model, run(command, stdin=DEVNULL, capture_output=True, encoding="utf-8"))
    if contents:
        with TemporaryDirectory(prefix="cusp-slice-") as folder, connect(arguments, folder) as client:
            slice_all(client, arguments, batch, contents, files)
    return batch.end()


if __name__ == "__main__":
    sys.exit(exit_code_of("slice.py", lambda: work(parse())))
