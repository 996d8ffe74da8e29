"""Runs orient.py for real: worker processes on this machine, one of them killed halfway.

    CUSP=target/release/cusp python -m unittest -v examples/cluster/test_orient.py
"""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import unittest
from pathlib import Path

from example import CUSP, PATIENCE, Example, wait_until

# A cusp that is killed whenever it measures a model of this many bytes.
DYING_CUSP = """#!/bin/sh
case "$*" in
    *--shard=*) [ "$(wc -c < "$2")" -eq {bytes} ] && kill -KILL $$ ;;
esac
exec '{cusp}' "$@"
"""


class Orient(Example):
    PROGRAM = "orient.py"
    options: list[str | Path] = ["--directions=60", "--alpha=0.3", "--json"]

    def cusp(self, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run([CUSP, "orient", *arguments], capture_output=True, text=True, timeout=PATIENCE)

    def in_one_process(self, *arguments: str | Path) -> str:
        """The expected answer; the command must succeed."""
        found = self.cusp(*arguments)
        self.assertEqual(found.returncode, 0, found.stderr)
        for line in found.stdout.splitlines():
            self.assertGreater(len(json.loads(line)["best"]), 0)
        return found.stdout

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
        with self.cluster() as (client, cluster):
            arguments = [f"--scheduler={cluster.scheduler_address}", f"--cusp={cusp}", f"--shards={shards}", *batch]
            example = self.start(*arguments)
            # Half of the calls went through; the next one belongs to a worker that waits for it.
            self.kill_a_worker(client, example, self.calls / str(half + 1) / "held")
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
        lines = [json.loads(line) for line in native.stdout.splitlines()]
        self.assertEqual(["error" in line for line in lines], [True, False, True, False, True])
        answers = [line for line in native.stdout.splitlines(keepends=True) if "error" not in json.loads(line)]
        good = self.in_one_process(self.wedge, self.spire, *self.options)
        self.assertEqual(("".join(answers), native.stderr.count("\n")), (good, 3))
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
            self.assertEqual((native.returncode, native.stderr.count("\n")), (1, 1))
            self.assertEqual(json.loads(native.stdout)["error"]["code"], "file")
            found = self.finish(self.start("--workers=2", f"--cusp={CUSP}", *batch))
            self.assertEqual(found, (1, native.stdout, native.stderr))

        missing = self.folder / "no-cusp"
        code, output, messages = self.finish(self.start("--workers=1", f"--cusp={missing}", self.wedge, self.spire))
        self.assertEqual((code, output, messages.count("\n")), (1, "", 1))
        self.assertIn("name the program by --cusp", messages)

    def test_errors_are_those_of_cusp(self) -> None:
        code, output, messages = self.finish(self.start("--workers=1", f"--cusp={CUSP}", self.wedge, "--alpha=7"))
        self.assertEqual((code, output, messages), (2, "", self.cusp(self.wedge, "--alpha=7").stderr))

        text = self.folder / "text.stl"
        text.write_text("no model\n")
        native = self.cusp(text, *self.options)
        found = self.finish(self.start("--workers=1", f"--cusp={CUSP}", text, *self.options))
        self.assertEqual(found, (1, native.stdout, native.stderr))
        # The messages name the given file, not a worker's copy.
        self.assertEqual(json.loads(native.stdout)["error"]["file"], str(text))
        self.assertIn(str(text), native.stderr)

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
            self.assertEqual(merged.returncode, 1)
            self.assertIn(message, json.loads(merged.stdout)["error"]["message"])
            self.assertIn(message, merged.stderr)
        merged = self.cusp(self.wedge, *self.options, "--merge", third, first, second)
        self.assertEqual(merged.stdout, self.in_one_process(self.wedge, *self.options))


if __name__ == "__main__":
    unittest.main()
