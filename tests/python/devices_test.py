"""Devices: those that the program lists."""

import json
import unittest

import exemplar
from shapes import PackageTest


class DevicesTest(PackageTest):
    def test_are_those_of_the_program(self):
        self.program("devices", "--no-measure", "--json", "devices.json")
        listed = json.loads((self.folder / "devices.json").read_text())["devices"]
        found = exemplar.devices()
        self.assertEqual([(d.index, d.name) for d in found], [(d["index"], d["name"]) for d in listed])
        self.assertTrue(found, "there is no Vulkan device")
        self.assertEqual(found[0].unusable, "")
        self.assertIn(found[0].name, repr(found[0]))
        self.assertGreater(found[0].memory, 0)

    def test_settings(self):
        exemplar.set_threads(1)
        exemplar.set_threads(0)
        self.raises(exemplar.UsageError, "threads: -1", exemplar.set_threads, -1)
        exemplar.show_progress(False)
        self.assertTrue(exemplar.feature_folder().endswith("features"), exemplar.feature_folder())
        self.assertTrue(exemplar.surface_folder().endswith("surfaces"), exemplar.surface_folder())


if __name__ == "__main__":
    unittest.main()
