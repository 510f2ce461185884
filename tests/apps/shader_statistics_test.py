#!/usr/bin/env python3
"""exemplar bench shaders --statistics: kernels on graphics cards, as Mesa's compiler sees them, beside tests/bench/shader_statistics.json.

After a wanted change, or with another Mesa, 'tests/apps/shader_statistics_test.py --renew' writes that file and the table of
docs/shaders.md anew. An entry with spills or scratch needs "accepted": "why"; renewing keeps these words."""

import json
import pathlib
import sys
import unittest

from program import DOCS, ProgramTest

BASELINE = pathlib.Path(__file__).parents[1] / "bench" / "shader_statistics.json"
PAGE = DOCS / "shaders.md"
SPILLS = ["spilled_vgprs", "spilled_sgprs", "scratch_bytes"]
NUMBERS = ["vgprs", *SPILLS, "subgroups_per_simd", "instructions", "latency", "inverse_throughput"]
COLUMNS = ["vgprs", "scratch_bytes", "subgroups_per_simd", "instructions", "latency", "inverse_throughput"]  # of the page
DRIVERS = ["/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d"]


def radv():
    """The file of Mesa's driver of AMD's cards; None if it is not installed."""
    return next((file for folder in DRIVERS for file in pathlib.Path(folder).glob("radeon_icd*.json")), None)


def defaults(report):
    """{family: {(kernel, variant): entry}} of what runs by default."""
    return {family["family"]: {(entry["kernel"], entry["variant"]): entry for entry in family["kernels"] if entry["default"]}
            for family in report["families"]}


def renewed(report, before):
    """The baseline of a report, with the accepted entries of an earlier one."""
    reasons = {(family["family"], entry["kernel"], entry["variant"]): entry["accepted"]
               for family in before.get("families", []) for entry in family["kernels"] if "accepted" in entry}
    families = []
    for family in report["families"]:
        entries = []
        for (kernel, variant), entry in defaults(report)[family["family"]].items():
            kept = {"kernel": kernel, "variant": variant, "default": True} | {key: entry[key] for key in NUMBERS}
            reason = reasons.get((family["family"], kernel, variant))
            if any(entry[key] for key in SPILLS):
                kept["accepted"] = reason or ""
            entries.append(kept)
        families.append({key: family[key] for key in ("family", "device", "driver")} | {"kernels": entries})
    return {"families": families}


def text_of(baseline):
    """The baseline as JSON, a line for each kernel."""
    families = []
    for family in baseline["families"]:
        head = ", ".join(f"{json.dumps(key)}: {json.dumps(family[key])}" for key in ("family", "device", "driver"))
        entries = ",\n  ".join(json.dumps(entry) for entry in family["kernels"])
        families.append(f"{{{head}, \"kernels\": [\n  {entries}]}}")
    return "{\"families\": [\n" + ",\n".join(families) + "]}\n"


def table_of(baseline):
    """The lines of the table in docs/shaders.md; a cell has the numbers of all families."""
    families = defaults(baseline)
    head = [f"kernel ({baseline['families'][0]['driver']})", "variant", "VGPRs", "scratch, bytes", "subgroups per SIMD", "instructions", "latency",
            "inverse throughput"]
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    for kernel, variant in next(iter(families.values())):
        cells = [" / ".join(f"{entries[kernel, variant][column]:,}" for entries in families.values()) for column in COLUMNS]
        lines.append("| " + " | ".join([f"`{kernel}`", variant, *cells]) + " |")
    return lines


def renew():
    ShaderStatistics.setUpClass()
    before = json.loads(BASELINE.read_text()) if BASELINE.exists() else {}
    baseline = renewed(ShaderStatistics.report, before)
    BASELINE.write_text(text_of(baseline))
    lines = PAGE.read_text().split("\n")
    table = table_of(baseline)
    first = next(i for i, line in enumerate(lines) if line.startswith("| kernel (Mesa "))
    end = next(i for i in range(first, len(lines)) if not lines[i].startswith("|"))
    PAGE.write_text("\n".join(lines[:first] + table + lines[end:]))
    for family, entries in defaults(baseline).items():
        for (kernel, variant), entry in entries.items():
            if entry.get("accepted") == "":
                print(f"{BASELINE}: {family}, {kernel} ({variant}) has spills or scratch; say why in \"accepted\"")
    ShaderStatistics.doClassCleanups()


class ShaderStatistics(ProgramTest):
    @classmethod
    def setUpClass(cls):
        if radv() is None:
            raise unittest.SkipTest("Mesa's driver of AMD's cards is not installed (Debian: mesa-vulkan-drivers)")
        super().setUpClass()
        cls.printed = cls.call("bench", "shaders", "--statistics", "--json", "now.json", "--quiet", timeout=900).stdout
        cls.report = json.loads((cls.folder / "now.json").read_text())

    def statistics(self, *options, code=0):
        return self.call("bench", "shaders", "--statistics", "--quiet", *options, code=code)

    def baseline(self):
        """The committed baseline; skips the test if it is of another compiler."""
        baseline = json.loads(BASELINE.read_text())
        driver, known = self.report["families"][0]["driver"], baseline["families"][0]["driver"]
        if driver != known:
            self.skipTest(f"the baseline is of {known}, this is {driver}")
        return baseline

    def test_kernels_are_no_worse_than_the_baseline(self):
        self.baseline()
        self.statistics("--baseline", BASELINE)

    def test_the_baseline_has_all_kernels_and_only_accepted_scratch(self):
        baseline = self.baseline()
        self.assertEqual({family: set(entries) for family, entries in defaults(baseline).items()},
                         {family: set(entries) for family, entries in defaults(self.report).items()},
                         "renew it: tests/apps/shader_statistics_test.py --renew")
        for family in baseline["families"]:
            for entry in family["kernels"]:
                if any(entry[key] for key in SPILLS):
                    self.assertTrue(entry.get("accepted"), entry)

    def test_the_page_shows_the_baseline(self):
        self.assertIn("\n".join(table_of(json.loads(BASELINE.read_text()))), PAGE.read_text(),
                      "renew it: tests/apps/shader_statistics_test.py --renew")

    def test_all_numbers_of_all_kernels_are_printed(self):
        for family in self.report["families"]:
            self.assertIn(f"{family['family']}: {family['device']}, {family['driver']}", self.printed)
            for entry in family["kernels"]:
                self.assertTrue(set(NUMBERS) <= set(entry), entry)
                self.assertGreater(entry["instructions"], 0)
        line = next(line for line in self.printed.splitlines() if line.startswith("* runtime/copy.comp"))
        entry = defaults(self.report)["NAVI21"]["runtime/copy.comp", ""]
        self.assertEqual([int(word) for word in line.split()[2:]],
                         [entry[key] for key in ["vgprs", "sgprs", *SPILLS, "lds_bytes", "subgroups_per_simd", "code_bytes",
                                                 "instructions", "latency", "inverse_throughput"]])

    def test_compilations_are_equal(self):
        self.statistics("--filter", "reproject|scan", "--json", "again.json")
        again = defaults(json.loads((self.folder / "again.json").read_text()))
        for family, entries in again.items():
            for key, entry in entries.items():
                self.assertEqual(entry, defaults(self.report)[family][key])

    def test_worse_code_is_noticed(self):
        old = json.loads((self.folder / "now.json").read_text())
        entry = next(e for e in old["families"][0]["kernels"] if e["kernel"] == "runtime/multiply_add.comp" and e["default"])
        entry["inverse_throughput"] = int(0.9 * entry["inverse_throughput"])
        entry["instructions"] += 1
        (self.folder / "old.json").write_text(json.dumps(old))
        result = self.statistics("--filter", "multiply_add", "--baseline", "old.json", code=1)
        self.assertIn("inverse_throughput", next(line for line in result.stdout.splitlines() if line.endswith("WORSE")))
        self.assertIn("instructions", result.stdout)
        self.assertIn("error: 1 numbers of kernels", result.stderr)
        entry["accepted"] = "as a test"
        (self.folder / "old.json").write_text(json.dumps(old))
        self.assertIn("accepted: as a test", self.statistics("--filter", "multiply_add", "--baseline", "old.json").stdout)
        self.assertIn("Nothing has changed", self.statistics("--filter", "copy", "--baseline", "old.json").stdout)

    def test_baselines_that_do_not_fit_are_refused(self):
        old = json.loads((self.folder / "now.json").read_text())
        old["families"][1]["driver"] = "Mesa 1.0"
        (self.folder / "other.json").write_text(json.dumps(old))
        command = ["bench", "shaders", "--statistics", "--quiet", "--filter", "copy", "--baseline"]
        self.refused(*command, "other.json", code=2, says=["other.json", "Mesa 1.0"])
        (self.folder / "odd.json").write_text("{}")
        self.refused(*command, "odd.json", code=1, says=["odd.json", "--statistics"])
        self.refused(*command, "now.json", "--families", "POLARIS10", code=2, says=["now.json", "POLARIS10"])

    def test_times_stand_beside_them(self):
        self.call("bench", "shaders", "--filter", "copy", "--sizes", "500", "--repeats", "2", "--quiet", "--json", "times.json")
        text = self.statistics("--filter", "copy", "--families", "navi21", "--times", "times.json").stdout
        self.assertIn("; ms on ", text)
        self.assertRegex(text, r"\* runtime/copy\.comp .* \d+\.\d{3}\n")

    def test_wrong_arguments_are_refused(self):
        command = ["bench", "shaders"]
        self.refused(*command, "--statistics", "--families", "FOO", code=2, says=["'FOO'", "NAVI21"])
        for option in ["--tune", "--list"]:
            self.refused(*command, "--statistics", option, code=2, says=["--statistics", option])
        self.refused(*command, "--statistics", "--device", "0", code=2, says=["--families", "--device"])
        self.refused(*command, "--families", "NAVI21", code=2, says=["--families", "--statistics"])

    def test_a_device_without_hardware_is_listed_and_refused(self):
        before = dict(self.environment)
        type(self).environment.update(RADV_FORCE_FAMILY="NAVI21", VK_ICD_FILENAMES=str(radv()), VK_DRIVER_FILES=str(radv()))
        try:
            devices = self.call("devices", code=1)
            doctor = self.call("doctor", code=1)
            self.refused("bench", "shaders", "--filter", "copy", code=1, says=["RADV NAVI21", "no memory"])
        finally:
            type(self).environment = before
        self.assertIn("RADV NAVI21", devices.stdout)
        self.assertIn("no memory", devices.stderr)
        self.assertIn("no memory", doctor.stdout)


if __name__ == "__main__":
    renew() if sys.argv[1:] == ["--renew"] else unittest.main()
