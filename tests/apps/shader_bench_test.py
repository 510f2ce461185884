"""exemplar bench shaders: what it prints and keeps, and that a slower kernel is noticed; not how fast anything is."""

import json
import unittest

from program import ProgramTest

SMALL = ["--sizes", "500", "--repeats", "2", "--quiet"]


class ShaderBench(ProgramTest):
    def bench(self, *options, code=0):
        return self.call("bench", "shaders", *SMALL, *options, code=code)

    def report(self, name):
        return json.loads((self.folder / name).read_text())

    def test_the_list_has_all_kernels_and_measures_nothing(self):
        text = self.call("bench", "shaders", "--list").stdout
        for part in ["stump scoring (5000, 20000, 100000 faces)", "learn/stumps.comp", "lines/write_traces.comp"]:
            self.assertIn(part, text)
        some = self.call("bench", "shaders", "--list", "--filter", "context_axes").stdout
        self.assertIn("labeling/context_axes.comp", some)
        self.assertNotIn("context_geodesic", some)

    def test_kernels_are_compared_and_timed(self):
        text = self.bench("--filter", "stump scoring|orientations", "--json", "r.json").stdout
        report = self.report("r.json")
        self.assertIn("copy_gb_per_s", report["device"])
        self.assertEqual([m["operation"] for m in report["measurements"]], ["stump scoring", "style evaluation"])
        for measurement in report["measurements"]:
            self.assertEqual(measurement["size"], 500)
            for difference in measurement["differences"]:
                self.assertLessEqual(difference["largest"], difference["tolerance"])
            # Of an operation only the kernels that are asked for.
            (kernel,) = measurement["kernels"]
            self.assertIn(kernel["kernel"], text)
            self.assertEqual(len(kernel["ms_of_repeats"]), 2)
            self.assertGreater(kernel["ms"], 0)
            self.assertAlmostEqual(kernel["gb_per_s"], 1e-6 * kernel["bytes"] / kernel["ms"], places=6)
            self.assertEqual(set(measurement["references_ms"]), {"runtime/copy.comp", "runtime/multiply_add.comp"})

    def test_a_slower_kernel_is_noticed(self):
        self.bench("--filter", "stump scoring", "--json", "now.json")
        old = self.report("now.json")
        kernel = old["measurements"][0]["kernels"][0]
        kernel["ms_of_repeats"] = [0.01 * ms for ms in kernel["ms_of_repeats"]]
        (self.folder / "fast.json").write_text(json.dumps(old))
        result = self.bench("--filter", "stump scoring", "--baseline", "fast.json", code=1)
        self.assertIn("SLOWER", result.stdout)
        self.assertIn("1 of 1 kernels are slower", result.stderr)
        kernel["ms_of_repeats"] = [1e4 * ms for ms in kernel["ms_of_repeats"]]
        (self.folder / "slow.json").write_text(json.dumps(old))
        self.assertIn("faster", self.bench("--filter", "stump scoring", "--baseline", "slow.json").stdout)

    def test_baselines_that_do_not_fit_are_refused(self):
        self.bench("--filter", "stump scoring", "--json", "now.json")
        report = self.report("now.json")
        report["device"]["name"] = "Other"
        (self.folder / "other.json").write_text(json.dumps(report))
        self.refused("bench", "shaders", *SMALL, "--baseline", "other.json", code=2, says=["other.json", "'Other'"])
        (self.folder / "odd.json").write_text("{}")
        self.refused("bench", "shaders", *SMALL, "--baseline", "odd.json", code=1, says=["odd.json", "--json"])
        self.refused("bench", "shaders", *SMALL, "--filter", "orientations", "--baseline", "now.json", code=2,
                     says="baseline has none")

    def test_the_fastest_variants_are_kept_and_used(self):
        text = self.bench("--tune", "--filter", "context_geodesic", "--json", "tuned.json").stdout
        report = self.report("tuned.json")
        self.assertEqual([v["parameter"] for v in report["variants"]], ["group", "faces"])
        self.assertIn("as it is", text)
        (kept,) = (self.folder / "cache" / "exemplar").glob("tuning-*.json")
        kernels = json.loads(kept.read_text())["kernels"]
        chosen = {v["parameter"]: v["chosen"] for v in report["variants"] if v["chosen"] is not None}
        self.assertEqual(kernels.get("labeling/context_geodesic.comp", {}), chosen)
        # A damaged file costs nothing but what it knew.
        kept.write_text("{")
        self.bench("--filter", "context_geodesic")
        kept.unlink()

    def test_what_changes_the_hosts_work_is_judged_by_whole_runs(self):
        text = self.bench("--tune", "--filter", "stumps", "--json", "tuned.json").stdout
        times_of = {v["parameter"]: v["times_of"] for v in self.report("tuned.json")["variants"]}
        self.assertEqual(times_of.pop("bits"), "whole runs")
        self.assertEqual(set(times_of.values()), {"the kernel"})
        self.assertEqual(text.count("bits, by whole runs"), 1)

    def test_wrong_arguments_are_refused(self):
        self.refused("bench", "shaders", "--filter", "[", code=2, says=["'['", "--filter"])
        self.refused("bench", "shaders", "--filter", "nothing like it", code=2, says="--list")
        self.refused("bench", "shaders", "--tune", "--baseline", "x.json", code=2, says=["--tune", "--baseline"])


if __name__ == "__main__":
    unittest.main()
