"""Runs the programs of examples/dask on two workers, and holds their results to those of a single process.

    CUSP=PATH/OF/cusp python -m unittest -v
"""

from __future__ import annotations

import json
import logging
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from distributed import Client, LocalCluster

from common import CUSP, PATIENCE, write_frustum

PROGRAMS = Path(__file__).parents[3] / "examples" / "dask"
# Shards of a model, as orient.py has them.
SHARDS = 8

WEDGE = [(0, 0), (8, 0), (8, 5), (0, 5)], [(0, 0), (5, 0), (5, 5), (0, 5)], 6
SPIRE = [(0, 0), (6, 0), (0, 4)], [(1, 1), (2, 1), (1, 2)], 7

# A cusp that numbers its calls, and kills itself and its caller, a worker, in one of them.
KILLING_CUSP = """#!/bin/sh
number=1
until mkdir '{calls}'/$number 2>/dev/null; do number=$((number + 1)); done
if [ $number -eq {fatal} ]; then
    echo $PPID > '{calls}'/killed
    kill -KILL $PPID $$
fi
exec '{cusp}' "$@"
"""

# A cusp that is killed whenever it reads the model `doomed.stl`, but not where all models are merged.
DYING_CUSP = """#!/bin/sh
case "$*" in
    *--merge=*) ;;
    *doomed.stl) kill -KILL $$ ;;
esac
exec '{cusp}' "$@"
"""


@unittest.skipUnless(os.name == "posix", "needs signals and a shell")
class Cluster(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        """Starts the workers, with a `cusp` on their PATH that tests may replace."""
        home = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="cusp-cluster-")))
        cls.cusp = home / "bin" / "cusp"
        cls.cusp.parent.mkdir()
        cls.enterClassContext(mock.patch.dict(os.environ, PATH=f"{cls.cusp.parent}{os.pathsep}{os.environ['PATH']}"))
        cluster = LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            host="127.0.0.1",
            dashboard_address=None,
            local_directory=str(home),
            # A test loses a worker on purpose.
            silence_logs=logging.CRITICAL,
        )
        cls.scheduler = cls.enterClassContext(cluster).scheduler_address
        cls.client = cls.enterClassContext(Client(cluster))
        for name in ["orient.py", "slice.py"]:
            shutil.copy(PROGRAMS / name, home / name)
        cls.home = home

    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory(dir=self.home)))
        self.models = self.folder / "models"
        self.models.mkdir()
        self.use_cusp('#!/bin/sh\nexec \'{cusp}\' "$@"\n')

    def use_cusp(self, text: str, **values: object) -> None:
        self.cusp.unlink(missing_ok=True)
        self.cusp.write_text(text.format(cusp=CUSP, **values))
        self.cusp.chmod(0o755)

    def run_here(self, *command: str | Path) -> tuple[int, str, str]:
        """Returns the exit code, the output and the messages of a command, run where the test keeps its files."""
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, cwd=self.folder)
        return done.returncode, done.stdout, done.stderr

    def alone(self, *arguments: str | Path) -> tuple[int, str, str]:
        """What a single process does."""
        return self.run_here(CUSP, *arguments)

    def distributed(self, program: str, inputs: list[str], options: list[str]) -> tuple[int, str, str]:
        return self.run_here(sys.executable, self.home / program, self.scheduler, *inputs, "--", *options)

    def kill_a_worker_in(self, call: int) -> None:
        self.calls = self.folder / "calls"
        self.calls.mkdir()
        self.workers = {str(pid) for pid in self.client.run(os.getpid).values()}
        self.use_cusp(KILLING_CUSP, calls=self.calls, fatal=call)

    def check_killed(self, tasks: int) -> None:
        """A worker was killed, and what it had was done again."""
        self.assertIn((self.calls / "killed").read_text().strip(), self.workers)
        self.assertGreater(len(list(self.calls.glob("[0-9]*"))), tasks)


class Orient(Cluster):
    options = ["--directions=60", "--alpha=0.3", "--json"]

    def setUp(self) -> None:
        super().setUp()
        write_frustum(self.folder / "wedge.stl", *WEDGE)
        write_frustum(self.folder / "spire.stl", *SPIRE)

    def test_a_search_is_that_of_one_process(self) -> None:
        (self.folder / "resin.json").write_text('{"exposure_s": 1.5}')
        # A model given twice is answered twice.
        models, options = ["wedge.stl", "spire.stl", "wedge.stl"], [*self.options, "--cost", "time", "--resin", "resin.json"]
        found = self.distributed("orient.py", models, options)
        self.assertEqual(found, self.alone("orient", *models, *options))
        self.assertEqual((found[0], found[1].count("\n")), (0, 3))

    def test_bad_models_do_not_stop_the_others(self) -> None:
        (self.folder / "poem.stl").write_text("no model\n")
        models = ["poem.stl", "wedge.stl", "absent.stl", "spire.stl"]
        code, output, messages = self.distributed("orient.py", models, self.options)
        alone = self.alone("orient", *models, *self.options)
        self.assertEqual((code, output), alone[:2])
        self.assertEqual(["error" in json.loads(line) for line in output.splitlines()], [True, False, True, False])
        # Once more by workers, who have no file that is absent.
        self.assertEqual((code, messages), (1, alone[2] + alone[2].splitlines(keepends=True)[0]))

    def test_a_model_that_cusp_dies_of_does_not_stop_the_others(self) -> None:
        write_frustum(self.folder / "doomed.stl", *SPIRE)
        self.use_cusp(DYING_CUSP)
        code, output, messages = self.distributed("orient.py", ["doomed.stl", "wedge.stl"], self.options)
        self.assertEqual((code, output.splitlines(keepends=True)[1:]), (1, [self.alone("orient", "wedge.stl", *self.options)[1]]))
        self.assertEqual(messages.splitlines()[1:], ["doomed.stl: cusp was killed"])

    def test_a_worker_is_killed_half_way(self) -> None:
        models = ["wedge.stl", "spire.stl"]
        self.kill_a_worker_in(SHARDS + 1)
        # Messages are Dask's, of the loss.
        code, output, _ = self.distributed("orient.py", models, self.options)
        self.assertEqual((code, output), self.alone("orient", *models, *self.options)[:2])
        # The last call merges.
        self.check_killed(2 * SHARDS + 1)


class Slice(Cluster):
    options = ["--pitch=0.1", "--backend=cpu"]

    def setUp(self) -> None:
        super().setUp()
        for number in range(6):
            write_frustum(self.models / f"part.{number}.stl", *(SPIRE, WEDGE)[number % 2])

    def files(self, folder: str) -> dict[str, bytes]:
        return {path.name: path.read_bytes() for path in (self.folder / folder).iterdir()}

    def check_prints(self, models: list[str], options: list[str]) -> tuple[str, str]:
        """The print files are those of a single process; returns its output and messages, with the same names."""
        (self.folder / "alone").mkdir()
        code, *said = self.alone("slice", *(f"models/{model}" for model in models), *options, "-o", "alone/")
        self.assertEqual(code, 0)
        self.assertEqual(sorted(Path(name).stem for name in self.files("alone")), sorted(Path(model).stem for model in models))
        self.assertEqual(self.files("prints"), self.files("alone"))
        output, messages = (text.replace("models/", "").replace("alone/", "prints/") for text in said)
        return output, messages

    def test_print_files_are_those_of_one_process(self) -> None:
        (self.folder / "cusp.toml").write_text('printer = "saturn-3-ultra"\nlayer_max_mm = 0.12\n')
        (self.folder / "resin.json").write_text('{"exposure_s": 1.5}')
        options = ["--backend=cpu", "--config", "cusp.toml", "--resin=resin.json"]
        code, *said = self.distributed("slice.py", ["models"], options)
        self.assertEqual(code, 0)
        expected = self.check_prints(list(self.files("models")), options)
        # Lines come in any order.
        for found, text in zip(said, expected):
            self.assertEqual(sorted(found.splitlines()), sorted(text.splitlines()))

    def test_bad_models_do_not_stop_the_others(self) -> None:
        good = list(self.files("models"))
        (self.models / "poem.stl").write_text("no model\n")
        write_frustum(self.models / "doomed.stl", *WEDGE)
        self.use_cusp(DYING_CUSP)
        code, output, messages = self.distributed("slice.py", ["models"], [*self.options, "--json"])
        self.assertEqual(code, 1)
        # Each at once, in any order, and all again at the end.
        *once, count, poem, doomed = messages.splitlines()
        self.assertEqual((sorted(once), count), (sorted([poem, doomed]), f"2 of {len(good) + 2} models failed:"))
        self.assertRegex(poem, "^cusp: poem.stl: ")
        self.assertEqual(doomed, "doomed.stl: cusp was killed")
        lines = [json.loads(line) for line in output.splitlines()]
        self.assertEqual({line["model"]: "report" in line for line in lines}, {**dict.fromkeys(good, True), "poem.stl": False})
        self.check_prints(good, self.options)

    def test_models_of_the_same_print_file_are_refused(self) -> None:
        write_frustum(self.models / "part.0.OBJ", *WEDGE)
        found = self.distributed("slice.py", ["models"], self.options)
        self.assertEqual(found, (1, "", "two models would have the same print file\n"))
        self.assertFalse((self.folder / "prints").exists())

    def test_a_worker_is_killed_half_way(self) -> None:
        models = list(self.files("models"))
        self.kill_a_worker_in(len(models) // 2 + 1)
        # Messages are Dask's, of the loss.
        code, output, _ = self.distributed("slice.py", ["models"], self.options)
        self.assertEqual(code, 0)
        expected, _ = self.check_prints(models, self.options)
        self.assertEqual(sorted(output.splitlines()), sorted(expected.splitlines()))
        self.check_killed(len(models))


# It only holds what both need.
del Cluster

if __name__ == "__main__":
    unittest.main()
