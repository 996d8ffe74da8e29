"""Holds what every command prints as JSON to what `cusp schema` says of it, by a validator that shares nothing with their writer.

    CUSP=PATH/OF/cusp python -m unittest -v test_schemas
"""

from __future__ import annotations

import json
import subprocess
import tempfile
import unittest
import zipfile
from pathlib import Path
from typing import Any

import fastjsonschema

from common import CUSP, PATIENCE, write_frustum

DOCS = Path(__file__).parents[3] / "docs"


class Schemas(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="cusp-schemas-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.wedge = self.folder / "wedge.stl"
        write_frustum(self.wedge, [(0, 0), (8, 0), (8, 5), (0, 5)], [(0, 0), (5, 0), (5, 5), (0, 5)], 6)
        # Without its last facet, it has a hole, and reports have warnings.
        self.open = self.folder / "open.stl"
        stl = self.wedge.read_bytes()
        count = int.from_bytes(stl[80:84], "little") - 1
        self.open.write_bytes(stl[:80] + count.to_bytes(4, "little") + stl[84:-50])
        self.print = self.folder / "wedge.zip"

    def cusp(self, *arguments: str | Path, code: int = 0) -> str:
        found = subprocess.run([CUSP, *arguments], capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual(found.returncode, code, found.stderr)
        return found.stdout

    def planned(self, *arguments: str | Path, code: int = 0) -> str:
        return self.cusp(*arguments, "--pitch=0.1", "--backend=cpu", "--json", code=code)

    def check(self, name: str, text: str) -> Any:
        schema = json.loads(self.cusp("schema", name))
        validate, found = fastjsonschema.compile(schema), json.loads(text)
        validate(found)
        self.check_strict(schema, validate, found)
        return found

    def check_strict(self, schema: Any, validate: Any, found: Any) -> None:
        """The schema knows every key, and asks for those that are always there."""
        known = schema.get("properties", {})
        if not isinstance(found, dict) or not known:
            return
        if "model" in known and "output" in known:
            # A line of a batch has a report or an error.
            known = {*known, "report", "error"}
        self.assertLessEqual(set(found), set(known))
        for key in schema.get("required", []):
            with self.assertRaises(fastjsonschema.JsonSchemaException, msg=key):
                validate({other: value for other, value in found.items() if other != key})
            with self.assertRaises(fastjsonschema.JsonSchemaException, msg=key):
                validate({**found, key: {"not": "this"}})

    def test_plans_and_print_files(self) -> None:
        report = self.check("plan", self.planned("slice", self.wedge, "-o", self.print, "--max-thicknesses=2"))
        self.assertGreater(report["plates"][0]["layers"], 10)
        with zipfile.ZipFile(self.print) as archive:
            self.check("manifest", archive.read("manifest.json").decode())
        own = self.folder / "own.json"
        own.write_text('{"pixels": [300, 200], "pitch_um": [40, 40], "volume_mm": [12, 8, 20]}')
        self.check("printer", own.read_text())
        for options in [
            ["--planner=uniform", "--layer=0.05", "--range=0:1=0.05:0.05"],
            ["--metric=volume", "--minimize=time", "--plane=2.5"],
            ["--rotation=0,0,0,1", "--printer=saturn-3-ultra", "--height=5"],
        ]:
            self.check("plan", self.planned("plan", self.wedge, *options))
        self.check("plan", self.cusp("plan", self.wedge, f"--printer={own}", "--backend=cpu", "--json"))
        warned = self.check("plan", self.planned("plan", self.open))
        self.assertGreater(len(warned["plates"][0]["models"][0]["warnings"]), 0)
        inspection = self.check("inspect", self.cusp("inspect", self.print, "--json"))
        self.assertGreater(len(inspection["layer_values"]), 10)
        goo = self.folder / "wedge.goo"
        self.cusp("slice", self.wedge, "-o", goo, "--printer=saturn-3-ultra", "--backend=cpu")
        self.check("inspect", self.cusp("inspect", goo, "--json"))
        self.check("simulate", self.cusp("simulate", self.wedge, self.print, "--json"))
        plan = self.folder / "plan.json"
        plan.write_text(self.planned("plan", self.wedge, "--max-thicknesses=2"))
        self.check("check", self.planned("check", self.wedge))
        self.check("verify", self.cusp("verify", plan, self.wedge, "--print", self.print, "--json"))
        shop = self.shop()
        self.check("price", self.planned("price", self.wedge, shop[1]))
        verified = self.check("verify", self.cusp("verify", plan, self.wedge, *shop, "--copies=3", "--json"))
        self.assertEqual(verified["price"]["copies"], 3)

    def shop(self) -> list[str]:
        """What a shop accepts, and what it asks."""
        limits, prices = self.folder / "limits.json", self.folder / "prices.json"
        limits.write_text('{ "severity": { "loose-body": "review", "trap": "review" } }')
        self.check("limits", limits.read_text())
        document = (DOCS / "price.md").read_text()
        prices.write_text(document.split("```json\n")[1].split("```")[0])
        self.check("prices", prices.read_text())
        return [f"--limits={limits}", f"--prices={prices}"]

    def test_plates(self) -> None:
        job, plan = self.folder / "job.json", self.folder / "plates.json"
        plate = ["--pixels=200x150", "--pitch=0.1", "--backend=cpu"]
        self.check("plate", self.cusp("plate", f"{self.wedge}:5", self.open, *plate, "-o", job, "--json"))
        plan.write_text(self.cusp("plan", job, "--json"))
        report = self.check("plan", plan.read_text())
        self.assertGreater(len(report["plates"]), 1)
        self.check("verify", self.cusp("verify", plan, job, "--json"))
        self.check("verify", self.cusp("verify", plan, job, *self.shop(), "--json"))

    def test_studies(self) -> None:
        self.check("tradeoff", self.planned("tradeoff", self.wedge, "--points=5"))
        self.check("compare", self.planned("compare", self.wedge))
        self.check("contours", self.planned("contours", self.wedge, "-o", self.folder / "wedge.svg"))
        # In some directions it does not fit.
        search = ["--directions=30", "--backend=cpu", "--json", "--pixels=75x60"]
        found = self.check("orient", self.cusp("orient", self.wedge, "--pitch=0.1", *search))
        self.assertGreater(len(found["candidates"]), 30)
        self.check("info", self.cusp("info", self.open, "--json"))
        self.assertGreater(len(self.check("printers", self.cusp("printers", "--json"))), 50)

    def test_lines_of_batches(self) -> None:
        poem = self.folder / "poem.stl"
        poem.write_text("no model")
        prints = self.folder / "prints"
        prints.mkdir()
        models = [self.wedge, poem, self.folder / "absent.stl"]
        outcomes = []
        for name, lines in [
            ("batch-plan", self.planned("slice", *models, "-o", prints, code=1)),
            ("batch-plan", self.planned("plan", *models, code=1)),
            ("batch-info", self.cusp("info", *models, "--json", code=1)),
        ]:
            for line in lines.splitlines():
                found = self.check(name, line)
                outcomes.append("report" if "report" in found else found["error"]["code"])
        self.assertEqual(sorted(outcomes), 3 * ["file"] + 3 * ["report"] + 3 * ["unknown-file-kind"])

    def test_files_of_users(self) -> None:
        resin = self.folder / "resin.json"
        self.cusp("calibrate", "resin", "0.05=2.4", "0.1=3.5", "-o", resin)
        self.check("resin", resin.read_text())
        options = json.loads(self.planned("plan", self.wedge))["plates"][0]["options"]
        self.check("settings", json.dumps({**options, "weights": "wedge.weights"}))
        with self.assertRaises(fastjsonschema.JsonSchemaException):
            self.check("settings", '{"layer_maxi_mm": 0.1}')


if __name__ == "__main__":
    unittest.main()
