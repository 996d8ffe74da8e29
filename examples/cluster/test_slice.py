"""Runs slice.py for real: worker processes on this machine, one of them killed halfway.

    CUSP=target/release/cusp python -m unittest -v examples/cluster/test_slice.py
"""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import unittest
from pathlib import Path
from typing import Any

from example import CUSP, PATIENCE, Example, wait_until

# A cusp that is killed whenever it gets a model of this many bytes.
DYING_CUSP = """#!/bin/sh
[ "$(wc -c < "$2")" -eq {bytes} ] && kill -KILL $$
exec '{cusp}' "$@"
"""


class Slice(Example):
    PROGRAM = "slice.py"

    def setUp(self) -> None:
        super().setUp()
        self.prints = self.folder / "prints"
        self.prints.mkdir()
        self.alone = self.folder / "alone"
        self.alone.mkdir()
        self.options: list[str | Path] = ["--pitch=0.1", "--backend=cpu"]

    def cusp(self, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        command = [CUSP, "slice", *arguments, "--json", "-o", f"{self.alone}{os.sep}"]
        return subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)

    def lines(self, text: str) -> dict[str, dict[str, Any]]:
        """The lines by model, without what depends on the machine; there must be one for each."""
        lines = [json.loads(line) for line in text.splitlines()]
        for line in lines:
            line.get("report", {}).pop("timings_ms", None)
            line.pop("output", None)
        by_model = {line["model"]: line for line in lines}
        self.assertEqual(len(by_model), len(lines), "a model has two lines")
        return by_model

    def files(self, folder: Path) -> dict[str, bytes]:
        return {path.name: path.read_bytes() for path in folder.iterdir()}

    def copies(self, count: int) -> list[Path]:
        """Models of different names, every other one the same."""
        models = [self.folder / f"part.{number}.stl" for number in range(count)]
        for number, model in enumerate(models):
            model.write_bytes((self.spire, self.wedge)[number % 2].read_bytes())
        return models

    def test_a_batch_on_several_workers(self) -> None:
        resin = self.folder / "resin.json"
        resin.write_text('{"exposure_s": 1.5}')
        config = self.folder / "cusp.toml"
        config.write_text('printer = "saturn-3-ultra"\nlayer_max_mm = 0.12\n')
        batch = [*self.copies(7), *self.options, f"--resin={resin}", f"--config={config}"]
        native = self.cusp(*batch)
        code, output, messages = self.finish(self.start("--workers=3", f"--cusp={CUSP}", f"-o{self.prints}", *batch))
        self.assertEqual((code, native.returncode), (0, 0))
        # Warnings name the given files, not a worker's copies.
        self.assertEqual(sorted(messages.splitlines()), sorted(native.stderr.splitlines()))
        self.assertEqual(self.lines(output), self.lines(native.stdout))
        self.assertEqual(self.files(self.prints), self.files(self.alone))
        self.assertEqual(sorted(self.files(self.prints)), [f"part.{number}.goo" for number in range(7)])
        for line in map(json.loads, output.splitlines()):
            self.assertTrue(Path(line["output"]).is_file())

    def test_a_worker_is_killed_half_way(self) -> None:
        half = 4
        batch = [*self.copies(2 * half), *self.options]
        cusp = self.holding_cusp(free=half)
        with self.cluster() as (client, cluster):
            where = [f"--scheduler={cluster.scheduler_address}", f"--cusp={cusp}", f"--output={self.prints}"]
            example = self.start(*where, *batch)
            self.kill_a_worker(client, example, self.calls / str(half + 1) / "held")
            code, output, messages = self.finish(example)
        self.assertEqual((code, messages), (0, ""))
        native = self.cusp(*batch)
        self.assertEqual(self.lines(output), self.lines(native.stdout))
        self.assertEqual(self.files(self.prints), self.files(self.alone))
        # Those that the killed worker had are sliced again.
        self.assertGreater(len(list(self.calls.iterdir())) - 1, 2 * half)

    def test_an_interrupt_leaves_whole_files_alone(self) -> None:
        free = 2
        cusp = self.holding_cusp(free=free)
        models = self.copies(6)
        example = self.start("--workers=2", f"--cusp={cusp}", f"-o{self.prints}", *models, *self.options)
        wait_until(lambda: (self.calls / str(free + 2) / "held").exists(), "both workers hold a model")
        wait_until(lambda: len(list(self.prints.glob("part.*"))) == free, "what was done is written")
        os.kill(example.pid, signal.SIGTERM)
        try:
            example.wait(timeout=PATIENCE / 4)
        except subprocess.TimeoutExpired:
            # Python drops an interrupt that arrives during garbage collection; a user would press it again.
            os.kill(example.pid, signal.SIGTERM)
        code, output, messages = self.finish(example)
        self.assertEqual((code, messages), (130, ""))
        self.cusp(*models, *self.options)
        files, alone = self.files(self.prints), self.files(self.alone)
        self.assertEqual(len(files), free)
        self.assertEqual(files, {name: alone[name] for name in files})
        told = {Path(json.loads(line)["output"]).name for line in output.splitlines()}
        self.assertLessEqual(told, set(files))
        # The last may lack its line: the interrupt can come between the two.
        self.assertGreaterEqual(len(told), free - 1)

    def test_bad_models_are_collected(self) -> None:
        poem = self.folder / "poem.stl"
        poem.write_text("no model\n")
        absent = self.folder / "absent.stl"
        batch = [poem, self.wedge, absent, self.spire, *self.options]
        native = self.cusp(*batch)
        code, output, messages = self.finish(self.start("--workers=2", f"--cusp={CUSP}", f"-o{self.prints}", *batch))
        self.assertEqual((code, native.returncode), (1, 1))
        self.assertEqual(self.lines(output), self.lines(native.stdout))
        self.assertEqual(self.files(self.prints), self.files(self.alone))
        # Each at once, in any order, and all again at the end.
        said, again = native.stderr.splitlines(), messages.splitlines()
        self.assertEqual(sorted(again[:2]), sorted(said[:2]))
        self.assertEqual(again[2], said[2].replace("cusp:", "slice.py:"))
        self.assertEqual(again[3:], said[3:])

    def test_a_model_that_cusp_dies_of_does_not_stop_the_others(self) -> None:
        cusp = self.script("dying-cusp", DYING_CUSP.format(bytes=self.spire.stat().st_size, cusp=Path(CUSP).absolute()))
        batch = [self.spire, self.wedge, *self.options]
        code, output, messages = self.finish(self.start("--workers=2", f"--cusp={cusp}", f"-o{self.prints}", *batch))
        self.assertEqual(code, 1)
        self.assertEqual(list(self.files(self.prints)), ["wedge.zip"])
        death = f"{re.escape(str(cusp))} on tcp://[^ ]+ was ended by signal 9"
        line = f"slice.py: {re.escape(str(self.spire))}: {death}\n"
        self.assertRegex(messages, f"^{line}slice.py: 1 of 2 models failed:\n{line}$")
        self.assertEqual(self.lines(output)[str(self.spire)]["error"]["code"], "lost")

    def test_what_is_wrong_for_every_model_is_said_once(self) -> None:
        for wrong in ["--layer-min=0.2", f"--weights={self.wedge}", "--metric=beauty"]:
            batch = [self.wedge, self.spire, *self.options, wrong]
            native = self.cusp(*batch)
            found = self.finish(self.start("--workers=2", f"--cusp={CUSP}", f"-o{self.prints}", *batch))
            self.assertEqual(found, (native.returncode, "", native.stderr))
        twins = [self.wedge, self.prints / "WEDGE.stl"]
        code, output, messages = self.finish(self.start("--workers=1", f"--cusp={CUSP}", f"-o{self.alone}", *twins))
        self.assertEqual((code, output, messages.count("\n")), (1, "", 1))
        self.assertIn("would both become", messages)
        self.assertEqual((self.files(self.prints), self.files(self.alone)), ({}, {}))


if __name__ == "__main__":
    unittest.main()
