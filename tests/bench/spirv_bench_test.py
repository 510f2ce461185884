"""exemplar bench spirv: what it checks, prints and refuses; not how fast anything is. Needs glslangValidator."""

import array
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "apps"))
from program import ProgramTest

SAXPY = """#version 450
layout(local_size_x_id = 0) in;
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint count; float factor; };
layout(constant_id = 3) const float offset = 0.0;
layout(set = 0, binding = 0) readonly buffer X { float x[]; };
layout(set = 0, binding = 1) readonly buffer Y { float y[]; };
layout(set = 0, binding = 4) writeonly buffer Z { float z[]; };
void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i < count) z[i] = factor * x[i] + y[i] + offset;
}
"""
UNIFORM = """#version 450
layout(local_size_x = 1) in;
layout(set = 0, binding = 5) uniform Settings { float factor; };
layout(set = 0, binding = 0) buffer X { float x[]; };
void main() { x[0] = factor; }
"""
COUNTER = """#version 450
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer Counter { uint count; uint slots[]; };
void main() { slots[atomicAdd(count, 1)] = gl_GlobalInvocationID.x; }
"""
POINTER = """#version 450
#extension GL_EXT_buffer_reference : require
layout(buffer_reference) buffer Node { float value; };
layout(push_constant) uniform Push { Node first; };
void main() { first.value = 1.0; }
"""
HALF = """#version 450
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_shader_16bit_storage : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer X { float16_t x[]; };
layout(set = 0, binding = 1) buffer Y { double y[]; };
void main() { y[gl_GlobalInvocationID.x] += double(x[gl_GlobalInvocationID.x]); }
"""
TEXELS = """#version 450
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) uniform samplerBuffer x;
layout(set = 0, binding = 1) writeonly buffer Y { float y[]; };
void main() { y[gl_GlobalInvocationID.x] = texelFetch(x, int(gl_GlobalInvocationID.x)).x; }
"""
NESTED = """#version 450
struct Light { ivec3 place; float powers[2]; };
layout(local_size_x = 1) in;
layout(push_constant, std430) uniform Push { uint count; mat2x3 turn; Light light; vec2 last; };
layout(set = 0, binding = 0) writeonly buffer Out { float values[]; };
void main() {
    values[0] = float(count);
    for (uint i = 0; i < 6; ++i) values[1 + i] = turn[i / 3][i % 3];
    for (uint i = 0; i < 3; ++i) values[7 + i] = float(light.place[i]);
    for (uint i = 0; i < 2; ++i) { values[10 + i] = light.powers[i]; values[12 + i] = last[i]; }
}
"""
STRUCTURES = """#version 450
struct Point { vec3 place; int index; };
layout(local_size_x = 32) in;
layout(constant_id = 0) const int extra = 0;
layout(set = 0, binding = 0, std430) writeonly buffer Out { uint count; Point points[]; };
void main() {
    const int i = int(gl_GlobalInvocationID.x);
    if (i == 0) count = 32;
    points[i].place = vec3(i, 2 * i, i == 5 ? 3.0 + extra : 3.0);
    points[i].index = i;
}
"""
FRAGMENT = "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n"
COUNT = 1000
SIZE = ["--invocations", COUNT, "--push", f"{COUNT},2"]
QUICK = ["--repeats", "3", "--seconds", "0.5", "--quiet"]


def floats(path, values):
    with open(path, "wb") as file:
        array.array("f", values).tofile(file)


@unittest.skipUnless(shutil.which("glslangValidator"), "glslangValidator is not installed")
class SpirvBench(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write("saxpy.comp", SAXPY)
        cls.write("fragment.frag", FRAGMENT)
        for source, output in [("saxpy.comp", "saxpy.spv"), ("fragment.frag", "fragment.spv")]:
            subprocess.run(["glslangValidator", "--quiet", "--target-env", "vulkan1.2", "-o", output, source],
                           cwd=cls.folder, check=True, timeout=60)
        xs, ys = [0.25 * i for i in range(COUNT)], [1.0] * COUNT
        floats(cls.folder / "x.bin", xs)
        floats(cls.folder / "y.bin", ys)
        floats(cls.folder / "z.bin", [2 * x + y for x, y in zip(xs, ys)])

    @classmethod
    def write(cls, name, text):
        (cls.folder / name).write_text(text)

    def bench(self, *arguments, code=0):
        return self.call("bench", "spirv", *arguments, *QUICK, code=code)

    def wrong(self, *arguments, code, says):
        return self.refused("bench", "spirv", *arguments, *QUICK, code=code, says=says)

    def test_a_shader_is_checked_and_timed(self):
        given = ["--bind", "0=x.bin", "--bind", "1=y.bin", "--expect", "z.bin"]
        text = self.bench("saxpy.spv", *SIZE, *given, "--operations", 2 * COUNT, "--json", "r.json").stdout
        self.assertIn("binding 4 'Z' (written): 3.906 KiB", text)
        self.assertIn("1000 x 1 x 1 threads in workgroups of 64 x 1 x 1", text)
        report = json.loads((self.folder / "r.json").read_text())
        (check,) = report["checks"]
        self.assertEqual((check["binding"], check["differing"], check["numbers"]), (4, 0, COUNT))
        (kernel,) = report["measurements"][0]["kernels"]
        self.assertEqual((kernel["kernel"], kernel["bytes"], kernel["operations"]), ("saxpy.spv", 12 * COUNT, 2 * COUNT))
        self.assertGreater(kernel["ms"], 0)

    def test_a_slower_shader_is_noticed(self):
        self.bench("saxpy.spv", *SIZE, "--json", "now.json")
        report = json.loads((self.folder / "now.json").read_text())
        kernel = report["measurements"][0]["kernels"][0]
        kernel["ms_of_repeats"] = [1e-3 * ms for ms in kernel["ms_of_repeats"]]
        (self.folder / "fast.json").write_text(json.dumps(report))
        result = self.bench("saxpy.spv", *SIZE, "--baseline", "fast.json", code=1)
        self.assertIn("SLOWER", result.stdout)
        kernel["ms_of_repeats"] = [1e6 * ms for ms in kernel["ms_of_repeats"]]
        (self.folder / "slow.json").write_text(json.dumps(report))
        self.assertIn("faster", self.bench("saxpy.spv", *SIZE, "--baseline", "slow.json").stdout)

    def test_glsl_is_compiled(self):
        self.write("part.glsl", "const float k_one = 1.0;")
        (self.folder / "parts").mkdir(exist_ok=True)
        (self.folder / "part.glsl").rename(self.folder / "parts" / "part.glsl")
        self.write("including.comp", SAXPY.replace("#version 450", "#version 450\n#extension GL_GOOGLE_include_directive : require\n"
                                                   '#include "part.glsl"'))
        self.bench("including.comp", *SIZE, "--include", "parts")
        self.write("broken.comp", SAXPY.replace("factor * x[i]", "factor * nothing"))
        message = self.wrong("broken.comp", *SIZE, code=1, says=["broken.comp", "'nothing'", "glslangValidator"])
        self.assertIn("broken.comp:11", message)

    def test_accesses_out_of_bounds_are_found_with_their_line(self):
        self.write("beyond.comp", SAXPY.replace("x[i] +", "x[i + 100000] +"))
        self.bench("beyond.comp", *SIZE)
        self.addCleanup(self.environment.update, EXEMPLAR_VALIDATION=self.environment.get("EXEMPLAR_VALIDATION", "0"))
        self.environment["EXEMPLAR_VALIDATION"] = "gpu"
        self.bench("saxpy.comp", *SIZE)
        self.wrong("beyond.comp", *SIZE, code=1, says=["beyond.comp", "access out of bounds", "at line 11"])

    def test_tools_that_are_not_installed(self):
        self.addCleanup(self.environment.update, PATH=self.environment["PATH"])
        self.environment["PATH"] = "/nonexistent"
        self.wrong("saxpy.comp", *SIZE, code=2, says=["saxpy.comp", "glslang-tools"])
        self.assertIn("spirv-tools", self.call("bench", "spirv", "saxpy.spv", *SIZE, "--seconds", "0.5").stderr)

    def test_two_versions_are_compared(self):
        self.write("wide.comp", SAXPY.replace("local_size_x = 64", "local_size_x = 128"))
        text = self.bench("saxpy.spv", "--against", "wide.comp", *SIZE, "--json", "two.json").stdout
        self.assertRegex(text, r"saxpy.spv takes \d+\.\d+ \+- \d+\.\d+ of the time of wide.comp")
        report = json.loads((self.folder / "two.json").read_text())
        self.assertEqual([k["kernel"] for k in report["measurements"][0]["kernels"]], ["saxpy.spv", "wide.comp"])
        self.assertGreater(report["ratio"]["value"], 0)

    def test_versions_that_differ_are_not_timed(self):
        given = ["--against", "saxpy.spv", "--against-spec", "3=0.5", *SIZE, "--bind", "0=:4000"]
        message = self.wrong("saxpy.spv", *given, code=1, says=["binding 4 'Z'", "1000 of 1000 numbers", "by up to 0.5", "not timed"])
        self.assertRegex(message, r"at element \d+ \([\d.]+, expected [\d.]+\)")
        self.bench("saxpy.spv", *given, "--tolerance", "0.6")

    def test_wrong_results_are_found(self):
        values = [0.5 * i + 1 for i in range(COUNT)]
        values[123] += 0.25
        floats(self.folder / "wrong.bin", values)
        given = ["--bind", "0=x.bin", "--bind", "1=y.bin"]
        self.wrong("saxpy.spv", *SIZE, *given, "--expect", "4=wrong.bin", code=1,
                   says=["wrong.bin", "1 of 1000 numbers", "element 123 (62.5, expected 62.75)"])
        self.wrong("saxpy.spv", *SIZE, *given, "--expect", "missing.bin", code=1, says="missing.bin")
        self.write("short.bin", "12345678")
        self.wrong("saxpy.spv", *SIZE, *given, "--expect", "short.bin", code=2, says=["short.bin", "8 bytes", "4000"])
        self.wrong("saxpy.spv", *SIZE, *given, "--expect", "0=x.bin", code=2, says="writes no binding 0")

    def test_specialization_constants(self):
        given = ["--bind", "0=x.bin", "--bind", "1=:4000", "--push", f"{COUNT},2", "--spec", "3=1.0"]
        self.bench("saxpy.spv", "--invocations", COUNT, *given, "--expect", "z.bin")
        text = self.bench("saxpy.spv", "--groups", "8", *given, "--spec", "0=128").stdout
        self.assertIn("1024 x 1 x 1 threads in workgroups of 128 x 1 x 1", text)
        self.wrong("saxpy.spv", *SIZE, "--spec", "7=1", code=2, says=["constant 7", "3 (float offset)"])
        self.wrong("saxpy.spv", *SIZE, "--spec", "3=red", code=2, says=["'red'", "float"])
        self.wrong("saxpy.spv", *SIZE, "--spec", "three", code=2, says=["--spec 'three'", "ID=VALUE"])
        self.wrong("saxpy.spv", *SIZE, "--spec", "0=100000", code=1, says=["workgroups of 100000", "limit"])

    def test_buffers_that_are_read_and_written_begin_anew_each_time(self):
        self.write("counter.comp", COUNTER)
        with open(self.folder / "counter.bin", "wb") as file:
            file.write(struct.pack("<I", 64) + bytes(4 * 64))
        # Each dispatch fills the slots once: a second one without a new beginning would write beyond them.
        text = self.bench("counter.comp", "--groups", "2", "--bind", "0=:260").stdout
        self.assertIn("(read, written)", text)
        self.wrong("counter.comp", "--groups", "2", "--bind", "0=:260", "--expect", "counter.bin", code=1, says=["of 65 numbers"])

    def test_push_constants_are_listed_in_the_order_of_memory(self):
        self.write("nested.comp", NESTED)
        floats(self.folder / "nested.bin", [float(i) for i in range(1, 15)])
        numbers = ",".join(map(str, range(1, 15)))
        self.bench("nested.comp", "--groups", "1", "--push", numbers, "--bind", "0=:56", "--expect", "nested.bin")
        self.wrong("nested.comp", "--groups", "1", "--push", "1", code=2,
                   says=["uint count", "float turn[1][2]", "int light.place[2]", "float light.powers[1]", "float last[1]"])

    def test_members_of_structures_are_named(self):
        self.write("structures.comp", STRUCTURES)
        given = ["--against", "structures.comp", "--groups", "1"]
        self.bench("structures.comp", *given)
        self.wrong("structures.comp", *given, "--against-spec", "0=2", code=1,
                   says=["1 of 129 numbers", "element 5.place[2] (3, expected 5)"])

    def test_numbers_of_other_sizes(self):
        self.write("half.comp", HALF)
        (self.folder / "h.bin").write_bytes(struct.pack("<64e", *range(64)))
        (self.folder / "d.bin").write_bytes(struct.pack("<64d", *range(64)))
        self.bench("half.comp", "--groups", "1", "--bind", "0=h.bin", "--expect", "d.bin")
        (self.folder / "d.bin").write_bytes(struct.pack("<64d", *range(63), 64))
        self.wrong("half.comp", "--groups", "1", "--bind", "0=h.bin", "--expect", "d.bin", code=1, says="element 63 (63, expected 64)")

    def test_texels(self):
        self.write("texels.comp", TEXELS)
        floats(self.folder / "t.bin", [0.5 * i for i in range(128)])
        floats(self.folder / "every_fourth.bin", [2.0 * i for i in range(32)])
        floats(self.folder / "each.bin", [0.5 * i for i in range(32)])
        self.bench("texels.comp", "--groups", "1", "--bind", "0=t.bin", "--expect", "every_fourth.bin")
        self.bench("texels.comp", "--groups", "1", "--bind", "0=t.bin", "--texels", "0=4", "--expect", "each.bin")
        self.wrong("texels.comp", "--groups", "1", "--texels", "0=8", code=2, says=["--texels 0=8", "4 bytes or 16"])

    def test_arrays_of_numpy(self):
        header = "{'descr': '<f4', 'fortran_order': False, 'shape': (1000,), }"
        header += " " * (63 - (10 + len(header)) % 64 + 1 - 1) + "\n"
        content = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + (self.folder / "x.bin").read_bytes()
        (self.folder / "x.npy").write_bytes(content)
        self.bench("saxpy.spv", *SIZE, "--bind", "0=x.npy", "--bind", "1=y.bin", "--expect", "z.bin")
        (self.folder / "bad.npy").write_bytes(b"nothing of numpy")
        self.wrong("saxpy.spv", *SIZE, "--bind", "0=bad.npy", code=1, says=["bad.npy", ".npy"])
        (self.folder / "order.npy").write_bytes(content.replace(b"False", b"True "))
        self.wrong("saxpy.spv", *SIZE, "--bind", "0=order.npy", code=1, says=["order.npy", "Fortran"])

    def test_wrong_inputs_are_refused(self):
        self.wrong("saxpy.spv", *SIZE, "--bind", "0=missing.bin", code=1, says="missing.bin")
        self.wrong("saxpy.spv", *SIZE, "--bind", "9=:4", code=2, says=["--bind 9", "no binding 9"])
        self.wrong("saxpy.spv", *SIZE, "--bind", "0=:4002", code=2, says=["4002 bytes", "elements of 4 bytes", "'X'"])
        self.wrong("saxpy.spv", *SIZE, "--bind", "0=:0", code=2, says=["0 bytes", "at least 4"])
        self.wrong("saxpy.spv", *SIZE, "--bind", "0=:4", "--bind", "0=:4", code=2, says=["--bind 0", "twice"])
        self.wrong("saxpy.spv", *SIZE, "--bind", "zero", code=2, says=["--bind 'zero'", "N=FILE"])
        self.wrong("saxpy.spv", *SIZE, "--bind", "0=random:many", code=2, says=["'many'", "4M"])
        self.wrong("saxpy.spv", *SIZE, "--bind", "0=:99999G", code=1, says=["binding 0", "limit"])
        self.wrong("saxpy.spv", "--push", "1,2", code=2, says=["--groups", "--invocations"])
        self.wrong("saxpy.spv", "--groups", "1,2,3,4", "--push", "1,2", code=2, says="X,Y,Z")
        self.wrong("saxpy.spv", "--groups", "0", "--push", "1,2", code=2, says="from 1")
        self.wrong("saxpy.spv", "--groups", "1000000", "--push", "1,2", "--bind", "0=:4", "--bind", "1=:4", "--bind", "4=:4", code=1,
                   says=["1000000 workgroups", "limit"])
        self.wrong("saxpy.spv", "--groups", "1", code=2, says=["--push", "uint count, float factor"])
        self.wrong("saxpy.spv", "--groups", "1", "--push", "1", code=2, says=["1 numbers", "uint count, float factor"])
        self.wrong("saxpy.spv", "--groups", "1", "--push", "-1,2", code=2, says=["'-1'", "'count'", "uint"])

    def test_wrong_shaders_are_refused(self):
        spirv = (self.folder / "saxpy.spv").read_bytes()
        for name, content, says in [("cut.spv", spirv[:-6], "truncated"), ("half.spv", spirv[:len(spirv) // 8 * 4], "half.spv"),
                                    ("noise.spv", bytes(range(256)), "no SPIR-V"), ("empty.spv", b"", "no SPIR-V"),
                                    ("damaged.spv", spirv[:20] + bytes(8) + spirv[28:], "byte 20"),
                                    ("bound.spv", spirv[:12] + b"\xff" * 4 + spirv[16:], "bound"),
                                    ("version.spv", spirv[:4] + b"\x00\x09\x01\x00" + spirv[8:], "1.9")]:
            with self.subTest(name):
                (self.folder / name).write_bytes(content)
                self.wrong(name, *SIZE, code=1, says=[name, says])
        self.wrong("fragment.spv", *SIZE, code=1, says=["fragment.spv", "a fragment shader"])
        self.wrong("missing.spv", *SIZE, code=1, says="missing.spv")
        self.write("uniform.comp", UNIFORM)
        self.wrong("uniform.comp", "--groups", "1", code=1, says=["uniform.comp", "binding 5 'Settings'", "uniform buffer"])
        self.write("pointer.comp", POINTER)
        self.wrong("pointer.comp", "--groups", "1", code=1, says=["pointer.comp", "capability"])

    def test_statistics_of_cards_without_a_card(self):
        self.write("two.comp", SAXPY.replace("factor * x[i]", "exp(factor * x[i])"))
        call = ["bench", "spirv", "two.comp", "--against", "saxpy.spv", "--spec", "3=1.5", "--statistics", "--families", "navi21"]
        if "install mesa-vulkan-drivers" in self.start(*call).communicate()[1]:
            self.skipTest("Mesa's driver of AMD's cards is not installed")
        text = self.call(*call, "--json", "s.json").stdout
        self.assertIn("VGPRs", text)
        report = json.loads((self.folder / "s.json").read_text())
        kernels = report["families"][0]["kernels"]
        self.assertEqual([(k["kernel"], k["variant"]) for k in kernels], [("two.comp", "3=1.5"), ("saxpy.spv", "3=1.5")])
        self.assertGreater(kernels[0]["instructions"], kernels[1]["instructions"])
        self.assertIn("Nothing has changed", self.call(*call, "--baseline", "s.json").stdout)
        kernels[0]["inverse_throughput"] = 1
        (self.folder / "better.json").write_text(json.dumps(report))
        self.refused(*call, "--baseline", "better.json", code=1, says="worse than in the baseline")

    def test_any_flipped_word_is_refused_or_run(self):
        # Whatever is damaged, spirv-val or the check of the module finds it, or it means something else that is valid.
        spirv = (self.folder / "saxpy.spv").read_bytes()
        for at in range(20, len(spirv), max(4, len(spirv) // 160 * 4)):
            (self.folder / "flipped.spv").write_bytes(spirv[:at] + b"\xff\xff" + spirv[at + 2:])
            process = self.start("bench", "spirv", "flipped.spv", *SIZE, "--repeats", "1", "--seconds", "0.1", "--quiet")
            process.communicate(timeout=60)
            self.assertIn(process.returncode, (0, 1, 2), at)


if __name__ == "__main__":
    unittest.main()
