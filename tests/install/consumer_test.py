"""Installs a build into a temporary folder, builds a project on it (the CMakeLists.txt beside this file), and runs its programs.

    consumer_test.py CMAKE BUILD_FOLDER COMPILER"""

import gzip
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent
CMAKE, BUILD, COMPILER = sys.argv[1:4] if len(sys.argv) > 3 else ("cmake", "build", "c++")
HAS_GPU = "EXEMPLAR_GPU:BOOL=ON" in (pathlib.Path(BUILD) / "CMakeCache.txt").read_text()
TETRAHEDRON = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"


def run(*command, code=0, environment=None):
    result = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            env={**os.environ, **(environment or {})}, timeout=250)
    if result.returncode != code:
        raise AssertionError(f"{' '.join(map(str, command))} gave {result.returncode} instead of {code}:\n{result.stdout}")
    return result.stdout


class Consumer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="exemplar-install-")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.prefix = cls.folder / "prefix"
        run(CMAKE, "--install", BUILD, "--prefix", cls.prefix)
        (cls.folder / "mesh.off").write_text(TETRAHEDRON)
        (cls.folder / "open.off").write_text(TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 1 2 3\n", ""))
        (cls.folder / "empty.off").write_text("OFF\n0 0 0\n")

    def build(self, name, *options, environment=None):
        """Folder of the programs of a consumer that is configured with `options`, and what was said meanwhile."""
        folder = self.folder / name
        said = run(CMAKE, "-S", HERE, "-B", folder, f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_COMPILER={COMPILER}",
                   "-DCMAKE_BUILD_TYPE=Release", *options, environment=environment)
        said += run(CMAKE, "--build", folder, "--verbose")
        return folder, said

    def check_host(self, program):
        # The variances of four points whose coordinates are all zero but for one each.
        expected = "4 faces, 0 boundary edges, variances "
        said = run(program, self.folder / "mesh.off")
        self.assertTrue(said.startswith(expected), said)
        variances = [float(word) for word in said.removeprefix(expected).split()]
        self.assertAlmostEqual(sum(variances), 3 / 16 * (1 + 4 + 9), delta=0.002)
        self.assertIn("3 boundary edges", run(program, self.folder / "open.off"))
        self.assertIn("empty.off", run(program, self.folder / "empty.off", code=1))

    def test_programs_of_both_targets(self):
        folder, said = self.build("both")
        self.check_host(folder / "host_consumer")
        # Warnings are a matter of each project.
        self.assertNotRegex(said, r"-Wall|-Wextra|-Wconversion|-fsanitize")
        if not HAS_GPU:
            return
        lines = run(folder / "gpu_consumer").splitlines()
        self.assertEqual(lines[0], "CPU: 0.0474 0.0474 0.9526")
        print(f"devices: {len(lines) - 1}")
        for line in lines[1:]:
            self.assertTrue(line.endswith(": 0.0474 0.0474 0.9526"), line)

    def test_the_host_alone_needs_no_vulkan_and_fits_another_instruction_set(self):
        # Without AVX Eigen would align, and free, memory in another way than libraries with it, were it not told.
        flags = {"CXXFLAGS": "-mno-avx"} if os.uname().machine == "x86_64" else {}
        folder, _ = self.build("host", "-DCMAKE_DISABLE_FIND_PACKAGE_Vulkan=ON", environment=flags)
        self.assertFalse((folder / "gpu_consumer").exists())
        self.check_host(folder / "host_consumer")

    def test_no_symbol_is_vulkans(self):
        """Libraries beside a loader, or another one's tables of functions, in one program."""
        libraries = sorted(self.prefix.rglob("libexemplar_*.a"))
        self.assertGreater(len(libraries), 10 if HAS_GPU else 5)
        for library in libraries:
            defined = run("nm", "--defined-only", "--extern-only", library)
            self.assertNotRegex(defined, r"(?m) [A-Z] vk[A-Z]", library.name)

    def test_the_example_draws_lines_over_pictures_of_its_own(self):
        if not HAS_GPU:
            self.skipTest("this build has no programs")
        program = self.prefix / "bin" / "exemplar"
        figure, model = self.folder / "figure_001.glb", self.folder / "figure.safetensors"
        run(program, "synth", "figure", "--vertices", "1000", "--frames", "24", "--out", self.folder)
        run(program, "curvature", "train", figure, "--out", model, "--augment", "40")
        folder = self.folder / "embed"
        run(CMAKE, "-S", HERE.parent.parent / "examples" / "embed_lines", "-B", folder, f"-DCMAKE_PREFIX_PATH={self.prefix}",
            f"-DCMAKE_CXX_COMPILER={COMPILER}", "-DCMAKE_BUILD_TYPE=Release")
        run(CMAKE, "--build", folder)
        # Small enough for a device that has the least that Vulkan asks for. In validation no message is an error.
        options = [figure, model, "--size", "250x240", "--white", "--validate"]
        run(folder / "embed_lines", *options, "--frames", "12", "--out", self.folder / "embedded")
        run(program, "lines", figure, "--model", model, "--types", "contours,suggestive_contours", "--view", "front", "--frames",
            "0:1", "--size", "250x240", "--out", self.folder / "alone.png")
        embedded = sorted((self.folder / "embedded").iterdir())
        self.assertEqual(len(embedded), 12)
        self.assertEqual(embedded[0].read_bytes(), (self.folder / "alone.png").read_bytes())
        swiftshader = pathlib.Path("/usr/lib/chromium/vk_swiftshader_icd.json")
        if swiftshader.exists():
            run(folder / "embed_lines", *options, "--frames", "3", "--out", self.folder / "swiftshader",
                environment={"VK_ICD_FILENAMES": str(swiftshader)})
            self.assertEqual(len(list((self.folder / "swiftshader").iterdir())), 3)
        self.assertIn("usage: embed_lines", run(folder / "embed_lines", code=1))
        self.assertIn("missing.glb", run(folder / "embed_lines", "missing.glb", model, "--out", "x", code=1))

    def test_programs_come_with_pages_and_completion(self):
        if not HAS_GPU:
            self.skipTest("this build has no programs")
        for name in ["exemplar", "exemplar-viewer"]:
            self.assertRegex(run(self.prefix / "bin" / name, "--version"), r"^\d+\.\d+\.\d+\n$")
            for file in [f"man/man1/{name}.1.gz", f"bash-completion/completions/{name}", f"zsh/vendor-completions/_{name}",
                         f"fish/vendor_completions.d/{name}.fish"]:
                self.assertTrue((self.prefix / "share" / file).is_file(), file)
        page = gzip.decompress((self.prefix / "share/man/man1/exemplar-label-train.1.gz").read_bytes()).decode()
        self.assertIn("default: \\(ti/.cache/exemplar/features", " ".join(page.split()))  # nobody's own home

    def test_headers_include_nothing_that_was_not_installed(self):
        root = self.prefix / "include" / "exemplar"
        headers = sorted(root.rglob("*.h"))
        self.assertGreater(len(headers), 100)
        for header in headers:
            for name in re.findall(r'^\s*#\s*include "([^"]+)"', header.read_text(), re.MULTILINE):
                self.assertTrue((root / name).exists(), f"{header} includes {name}")
        self.assertEqual([str(folder) for folder in root.rglob("*") if folder.is_dir() and not any(folder.iterdir())], [])

    def test_a_newer_version_is_refused(self):
        project = self.folder / "newer"
        project.mkdir()
        (project / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(newer LANGUAGES CXX)\n"
                                                "find_package(exemplar 99 REQUIRED)\n")
        said = run(CMAKE, "-S", project, "-B", project / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}", code=1)
        self.assertIn("requested version", said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
