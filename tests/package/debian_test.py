"""Installs the Debian packages into a Debian of their own, made by debootstrap, and runs what they bring.

    debian_test.py CMAKE

EXEMPLAR_PACKAGES names the folder of the packages (see apps/package.sh); exit code 77 says that the test was skipped, and why.

All of it happens in a mount and a process namespace, with the new system in the memory of a tmpfs: however this ends, killed or not,
no process, mount or file is left, but for the .deb files that ~/.cache/exemplar-tests/debs keeps for the next time."""

import json
import os
import pathlib
import subprocess
import sys
import unittest

SKIPPED = 77
SUITE = "bookworm"
CMAKE = sys.argv[1] if len(sys.argv) > 1 else "cmake"
CONSUMER = pathlib.Path(__file__).absolute().parents[1] / "install"
DEBS = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "exemplar-tests" / "debs"
MOUNT = pathlib.Path("/mnt")  # only in this namespace; what else is there stays hidden meanwhile
ROOT = MOUNT / "root"
QUICK = ["--rounds", "8", "--patience", "8", "--samples", "60", "--feature-fraction", "0.25"]


def why_skipped():
    if not os.environ.get("EXEMPLAR_PACKAGES"):
        return "EXEMPLAR_PACKAGES is not set ('tests/run.sh --package' builds packages and sets it)"
    if os.getuid() != 0:
        return "a system of its own can be set up as root alone"
    return None


def run(*command, code=0, **options):
    result = subprocess.run([str(word) for word in command], text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, **options)
    if result.returncode != code:
        raise AssertionError(f"{' '.join(map(str, command))} gave {result.returncode} instead of {code}:\n{result.stdout}")
    return result.stdout


def inside(*command, code=0):
    """Runs a command in the new system, with nothing of this one's environment but how the network is reached."""
    proxies = {name: value for name, value in os.environ.items() if name.lower().endswith("_proxy")}
    return run("chroot", ROOT, *command, code=code,
               env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LC_ALL": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive",
                    "XDG_RUNTIME_DIR": "/run/test", **proxies})


def mirror():
    """The mirror that this machine's own apt uses for the suite, if it does."""
    try:
        sites = run("apt-get", "indextargets", "--format", "$(REPO_URI)", "Created-By: Packages", f"Codename: {SUITE}").split()
    except (AssertionError, OSError):
        sites = []
    return sites[0] if sites else "http://deb.debian.org/debian"


def set_up_system(packages):
    """A minimal Debian with the packages in its folder /packages."""
    run("mount", "-t", "tmpfs", "-o", "size=4G,mode=755", "none", MOUNT)
    run("debootstrap", "--variant=minbase", f"--cache-dir={DEBS}", SUITE, ROOT, mirror())
    (ROOT / "packages").mkdir()
    for name, content in packages.items():
        (ROOT / "packages" / name).write_bytes(content)
    (ROOT / "run/test").mkdir(mode=0o700)
    run("mount", "-t", "proc", "none", ROOT / "proc")
    run("mount", "--bind", DEBS, ROOT / "var/cache/apt/archives")
    inside("apt-get", "-qq", "update")


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = pathlib.Path(os.environ["EXEMPLAR_PACKAGES"])
        packages = {path.name: path.read_bytes() for path in folder.glob("exemplar*.deb")}
        cls.program, cls.development = [[f"/packages/{name}" for name in packages if name.startswith(begin)] for begin in
                                        ("exemplar_", "exemplar-dev_")]
        if len(cls.program) != 1 or len(cls.development) != 1:
            raise AssertionError(f"{folder} should hold one package exemplar and one exemplar-dev; it has {list(packages)}")
        cls.program, cls.development = cls.program[0], cls.development[0]
        DEBS.mkdir(parents=True, exist_ok=True)
        set_up_system(packages)

    def test_1_installs_with_nothing_but_what_it_depends_on(self):
        inside("apt-get", "-qq", "install", "-y", "--no-install-recommends", self.program)
        self.assertRegex(inside("exemplar", "--version"), r"^\d+\.\d+\.\d+\n$")
        self.assertRegex(inside("exemplar-viewer", "--version"), r"^\d+\.\d+\.\d+\n$")
        self.assertIn("error: ", inside("exemplar", "devices", "--device", "0", code=1))  # there is no driver
        self.assertIn("libvulkan1", inside("dpkg-query", "-W", "-f", "${Depends}", "exemplar"))
        self.assertIn("mesa-vulkan-drivers", inside("dpkg-query", "-W", "-f", "${Recommends}", "exemplar"))

    def test_2_brings_pages_and_completion(self):
        for file in ["man/man1/exemplar.1.gz", "man/man1/exemplar-label-train.1.gz", "man/man1/exemplar-viewer.1.gz",
                     "bash-completion/completions/exemplar", "bash-completion/completions/exemplar-viewer",
                     "zsh/vendor-completions/_exemplar", "fish/vendor_completions.d/exemplar.fish",
                     "doc/exemplar/README.md", "doc/exemplar/copyright", "doc/exemplar/changelog.gz"]:
            self.assertTrue((ROOT / "usr/share" / file).is_file(), file)
        page = inside("gzip", "-dc", "/usr/share/man/man1/exemplar-label-train.1.gz")
        self.assertNotIn(os.path.expanduser("~/"), page)
        said = inside("bash", "-c", "source /usr/share/bash-completion/completions/exemplar; COMP_WORDS=(exemplar la); COMP_CWORD=1; "
                                    "_exemplar; echo ${COMPREPLY[@]}")
        self.assertEqual(said, "label\n")

    def test_3_computes_on_the_software_driver(self):
        inside("apt-get", "-qq", "install", "-y", "--no-install-recommends", "mesa-vulkan-drivers")
        inside("exemplar", "devices", "--no-measure", "--json", "/root/devices.json")
        devices = json.loads((ROOT / "root/devices.json").read_text())
        self.assertIn("llvmpipe", json.dumps(devices))
        inside("exemplar", "synth", "cup", "--count", "3", "--faces", "500", "--out", "/root/cups")
        inside("exemplar", "label", "train", "/root/cups", "--out", "/root/cup.safetensors", *QUICK)
        inside("exemplar", "label", "apply", "/root/cup.safetensors", "/root/cups/cup_001.off", "--out", "/root/labeled", "--png")
        self.assertTrue((ROOT / "root/labeled/cup_001_labels.txt").read_text().startswith("body\n"))
        self.assertEqual((ROOT / "root/labeled/cup_001.png").read_bytes()[:4], b"\x89PNG")

    def test_4_goes_without_a_trace(self):
        files = [ROOT / line[1:] for line in inside("dpkg", "-L", "exemplar").split("\n") if "exemplar" in line]
        self.assertGreater(len(files), 40)
        inside("apt-get", "-qq", "purge", "-y", "exemplar")
        self.assertEqual([str(file) for file in files if os.path.lexists(file)], [])

    def test_5_other_projects_build_on_it(self):
        # What exemplar-dev depends on is in Debian; this machine has it, so the project is built here.
        self.assertIn("Inst libembree-dev", inside("apt-get", "install", "-s", "--no-install-recommends", self.development))
        unpacked = MOUNT / "unpacked"
        run("dpkg-deb", "-x", ROOT / self.development[1:], unpacked)
        said = run(CMAKE, "-S", CONSUMER, "-B", MOUNT / "consumer", f"-DCMAKE_PREFIX_PATH={unpacked / 'usr'}",
                   "-DCMAKE_BUILD_TYPE=Release")
        said += run(CMAKE, "--build", MOUNT / "consumer", "--verbose")
        (MOUNT / "mesh.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        self.assertIn("1 faces, 3 boundary edges", run(MOUNT / "consumer/host_consumer", MOUNT / "mesh.off"))
        self.assertIn("CPU: 0.0474", run(MOUNT / "consumer/gpu_consumer"))
        self.assertNotIn("-march", said)  # packages are for every processor

    def test_6_follows_the_rules_of_debian(self):
        run("lintian", "--fail-on", "error", "--tag-display-limit", "0", "--allow-root", ROOT / self.program[1:],
            ROOT / self.development[1:])


if __name__ == "__main__":
    reason = why_skipped()
    if reason:
        print(f"skipped: {reason}")
        sys.exit(SKIPPED)
    if "--inside" not in sys.argv:
        # If unshare is killed, the kernel kills all that is inside.
        os.execvp("unshare", ["unshare", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc", sys.executable, "-B",
                              *sys.argv, "--inside"])
    unittest.main(argv=sys.argv[:1])
