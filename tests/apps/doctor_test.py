"""exemplar doctor on this machine as it is, and with what users get wrong."""

import json
import unittest

from program import ProgramTest


class Doctor(ProgramTest):
    def doctor(self, *options, code=0, **variables):
        before = dict(self.environment)
        type(self).environment.update(variables)
        try:
            result = self.call("doctor", *options, code=code)
        finally:
            type(self).environment = before
        return result

    def test_this_machine_can_be_used(self):
        result = self.doctor("--json", "d.json")
        self.assertIn("Exemplar can use this machine.", result.stdout)
        self.assertIn("stump scoring", result.stdout)
        report = json.loads((self.folder / "d.json").read_text())
        self.assertTrue(report["usable"])
        self.assertNotIn("fault", [finding["level"] for finding in report["findings"]])

    def test_a_variable_that_names_no_driver(self):
        result = self.doctor("--json", "d.json", code=1, VK_ICD_FILENAMES="/no/such/driver.json")
        self.assertIn("FAULT VK_ICD_FILENAMES names /no/such/driver.json", result.stdout)
        self.assertIn("-> correct or unset VK_ICD_FILENAMES", result.stdout)
        self.assertFalse(json.loads((self.folder / "d.json").read_text())["usable"])

    def test_a_device_that_is_not_there(self):
        self.assertIn("no such card", self.doctor(code=1, EXEMPLAR_DEVICE="no such card").stderr)

    def test_a_damaged_tuning(self):
        self.doctor()
        folder = self.folder / "cache" / "exemplar"
        (kept,) = folder.glob("pipelines-*.bin")
        tuning = folder / kept.name.replace("pipelines", "tuning").replace(".bin", ".json")
        tuning.write_text("{")
        result = self.doctor()
        self.assertIn(f"delete {tuning}", result.stdout)
        tuning.unlink()


if __name__ == "__main__":
    unittest.main()
