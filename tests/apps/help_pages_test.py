"""Man pages and completion that the programs write of themselves, asked of man, mandoc, bash, zsh and fish. Needs no Vulkan device."""

import os
import pathlib
import re
import shlex
import subprocess
import unittest

from program import PROGRAM, ProgramTest

VIEWER = pathlib.Path(os.environ.get("EXEMPLAR_VIEWER", "build/exemplar-viewer")).absolute()
LINE_TYPES = ["boundaries", "contours", "creases", "ridges", "valleys"]


class PagesTest(ProgramTest):
    """Pages of both programs, and the commands that --help tells of: {"exemplar label train": its help}."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.environment |= {"SOURCE_DATE_EPOCH": "1000000000", "LC_ALL": "C.UTF-8"}
        cls.call("--help-pages", "pages")
        cls.call("--help-pages", "pages", program=VIEWER)
        cls.pages = cls.folder / "pages"
        cls.helps = {}
        cls.walk([])
        cls.helps["exemplar-viewer"] = cls.call("--help", program=VIEWER).stdout

    @classmethod
    def walk(cls, words):
        text = cls.call(*words, "--help").stdout
        cls.helps[" ".join(["exemplar", *words])] = text
        for name in cls.entries(text, "Subcommands"):
            cls.walk([*words, name])

    @staticmethod
    def entries(text, heading):
        """The first words of the lines below a heading of --help."""
        block = re.search(rf"^{heading}:\n((?:  .*\n)*)", text, re.MULTILINE)
        return re.findall(r"^  (\S+)", block.group(1), re.MULTILINE) if block else []

    @classmethod
    def options(cls, command):
        return [name for names in cls.entries(cls.helps[command], "Options") for name in names.split(",")]


class ManPages(PagesTest):
    def page(self, command):
        """As man shows it."""
        path = self.pages / "man1" / (command.replace(" ", "-") + ".1")
        result = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-P-cbou", "-k", path], text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, timeout=60)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return re.sub(r"(?<=\S) +", " ", result.stdout)  # its lines are justified

    def test_a_page_for_each_command_and_no_other(self):
        self.assertGreater(len(self.helps), 30)
        self.assertEqual(sorted(path.name for path in (self.pages / "man1").iterdir()),
                         sorted(command.replace(" ", "-") + ".1" for command in self.helps))

    def test_pages_hold_every_option_and_subcommand_and_render_without_a_warning(self):
        for command, text in self.helps.items():
            with self.subTest(command):
                page = self.page(command)
                for option in self.options(command):
                    self.assertRegex(page, rf"(?m)^ +(.*, )?{re.escape(option)}\b")
                for name in self.entries(text, "Subcommands"):
                    self.assertIn(f"{command} {name}".replace(" ", "-") + "(1)", page)

    def test_checkers_find_nothing(self):
        pages = sorted((self.pages / "man1").iterdir())
        result = subprocess.run(["mandoc", "-Tlint", "-Wwarning", *pages], text=True, stdout=subprocess.PIPE, timeout=60)
        self.assertEqual((result.returncode, result.stdout), (0, ""))

    def test_what_a_page_says(self):
        page = self.page("exemplar label train")
        self.assertIn("exemplar-label-train - Learns a model from labeled meshes\n", page)
        self.assertRegex(page, r"exemplar label train \[OPTION\.\.\.\] \[SOURCE\.\.\.\]\n")
        self.assertRegex(page, r"\n +--rounds NUMBER\n +boosting rounds per classifier \(for boundaries at most\)\s+"
                               r"\(from\s+1\s+to\s+100000;\s+default:\s+300\)\n")
        self.assertIn("exemplar label train shapes --out human.safetensors --seed 1\n", page)
        self.assertRegex(page, r"SEE ALSO\n +exemplar\(1\), exemplar-label\(1\)\n")
        self.assertIn("2001-09-09", page)
        self.assertRegex(self.page("exemplar curvature train"), r"--bases WORD\n +ica or pca \(default: ica\)")
        self.assertRegex(self.page("exemplar"), r"Exit codes: 0 done, 1 error")
        self.assertNotIn("help-pages", self.page("exemplar"))
        self.assertNotIn("lose-device", self.page("exemplar-viewer"))

    def test_footers_keep_their_lines(self):
        synth = self.page("exemplar synth")
        self.assertRegex(synth, r"\n +Kinds of shapes: human [^\n]*\n +Kinds of animations: figure ")
        self.assertRegex(self.page("exemplar label stress"), r"\n +holes +\S")

    def test_a_wrong_date_is_refused(self):
        self.environment["SOURCE_DATE_EPOCH"] = "today"
        self.addCleanup(self.environment.update, SOURCE_DATE_EPOCH="1000000000")
        self.refused("--help-pages", "other", code=2, says=["SOURCE_DATE_EPOCH", "'today'"])


class Completion(PagesTest):
    """Asks each shell what it would offer at the end of a command line."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name in ["cow.off", "two words.off", "folder"]:
            (cls.folder / "here" / name).mkdir(parents=True)
        for name in ["cow.off", "two words.off"]:
            (cls.folder / "here" / name).rmdir()
            (cls.folder / "here" / name).write_text("")

    def run_shell(self, *command):
        result = subprocess.run(command, cwd=self.folder / "here", text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, timeout=60, env=self.environment | {"HOME": str(self.folder)})
        self.assertEqual((result.returncode, result.stderr), (0, ""), command)
        return sorted(filter(None, result.stdout.split("\n")))

    def bash(self, *words):
        """As bash calls it: it takes words apart at equal signs."""
        parts = [part for word in words for part in re.findall(r"=|[^=]+|^$", word)] or [""]
        function = "_" + words[0].replace("-", "_")
        return self.run_shell("bash", "--norc", "-c", f"source {shlex.quote(str(self.pages / 'bash' / words[0]))}\n"
                              f"COMP_WORDS=({shlex.join(parts)}); COMP_CWORD={len(parts) - 1}\n{function} {words[0]}\n"
                              r"""printf '%s\n' "${COMPREPLY[@]}" """)

    def fish(self, *words):
        line = " ".join(word and shlex.quote(word) for word in words)
        said = self.run_shell("fish", "--no-config", "-c", f"source {shlex.quote(str(self.pages / 'fish' / (words[0] + '.fish')))}\n"
                              f"complete -C {shlex.quote(line)}")
        return sorted({text.split("\t")[0].rstrip("/") for text in said})

    def test_bash_offers_every_subcommand_and_option(self):
        for command, text in self.helps.items():
            with self.subTest(command):
                self.assertEqual(self.bash(*command.split(), "-"), sorted(self.options(command)))
                names = self.entries(text, "Subcommands")
                if names:
                    self.assertEqual(self.bash(*command.split(), ""), sorted(names))

    def test_bash_goes_on_with_what_was_begun(self):
        self.assertEqual(self.bash("exemplar", "la"), ["label"])
        self.assertEqual(self.bash("exemplar", "label", "e"), ["evaluate"])
        self.assertEqual(self.bash("exemplar", "label", "train", "--st"), ["--stages"])
        self.assertEqual(self.bash("exemplar", "synth", "f"), ["face", "figure", "flag", "floor", "fourleg"])
        self.assertEqual(self.bash("exemplar", "nonsense", ""), self.bash("exemplar", ""))

    def test_bash_offers_the_words_of_options(self):
        self.assertEqual(self.bash("exemplar", "curvature", "train", "--bases", ""), ["ica", "pca"])
        self.assertEqual(self.bash("exemplar", "curvature", "train", "--bases="), ["ica", "pca"])
        self.assertEqual(self.bash("exemplar", "curvature", "train", "--bases=p"), ["pca"])
        types = self.bash("exemplar", "lines", "--types", "")
        self.assertEqual([name for name in LINE_TYPES if name not in types], [])
        self.assertEqual(self.bash("exemplar", "lines", "--types", "contours,cr"), ["contours,creases"])
        self.assertEqual(self.bash("exemplar", "lines", "--types=contours,cr"), ["contours,creases"])
        self.assertEqual(self.bash("exemplar", "bench", "--only", "cut", "sco"), ["scoring"])
        self.assertEqual(self.bash("exemplar-viewer", "--paint", "m"), ["mean"])

    def test_bash_offers_files_and_folders_where_they_belong(self):
        everything = ["cow.off", "folder", "two words.off"]
        self.assertEqual(self.bash("exemplar", "label", "train", ""), everything)
        self.assertEqual(self.bash("exemplar", "label", "train", "two"), ["two words.off"])
        self.assertEqual(self.bash("exemplar", "label", "train", "cow.off", "--out", ""), everything)
        self.assertEqual(self.bash("exemplar", "label", "apply", "--out", ""), ["folder"])
        self.assertEqual(self.bash("exemplar", "label", "train", "--seed", ""), [])
        self.assertEqual(self.bash("exemplar", "devices", ""), [])
        self.assertIn("cow.off", self.bash("exemplar", "lines", "--style", ""))
        self.assertIn("pencil", self.bash("exemplar", "lines", "--style", ""))
        self.assertIn("cow.off", self.bash("exemplar-viewer", ""))

    def test_fish_offers_the_same(self):
        self.assertEqual(self.fish("exemplar", "la"), ["label"])
        self.assertEqual(self.fish("exemplar", "label", ""), sorted(self.entries(self.helps["exemplar label"], "Subcommands")))
        for command in ["exemplar", "exemplar label train", "exemplar lines", "exemplar-viewer"]:
            with self.subTest(command):
                self.assertEqual(self.fish(*command.split(), "--"),
                                 sorted(option for option in self.options(command) if option.startswith("--")))
        self.assertEqual(self.fish("exemplar", "curvature", "train", "--bases", ""), ["ica", "pca"])
        self.assertIn("contours,creases", self.fish("exemplar", "lines", "--types", "contours,cr"))
        self.assertEqual(self.fish("exemplar", "label", "train", ""), ["cow.off", "folder", "two words.off"])
        self.assertEqual(self.fish("exemplar", "label", "apply", "--out", ""), ["folder"])
        self.assertEqual(self.fish("exemplar", "label", "train", "--seed", ""), [])

    def zsh(self, *words):
        """Runs a zsh in a terminal of another one, which types the line and Tab, and reads what is listed below it."""
        line = " ".join(words)
        script = r"""
            zmodload zsh/zpty
            zpty shell zsh -f -i
            zpty -w shell 'unsetopt prompt_cr prompt_sp beep; stty -echo cols 4000 rows 200; LISTMAX=0'
            zpty -w shell 'fpath=($PAGES $fpath); autoload -U compinit; compinit -u -D; bindkey "^I" list-choices'
            zpty -w shell 'zstyle ":completion:*" verbose no; PROMPT=REA""DY'
            zpty -r shell out '*READY*'
            zpty -w -n shell $LINE$'\t'
            zpty -w -n shell $'\C-u'
            zpty -w shell 'print FINI""SHED'
            zpty -r shell out '*FINISHED*'
            print -r -- $out
            zpty -d shell"""
        result = subprocess.run(["zsh", "-f", "-c", script], cwd=self.folder / "here", text=True, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60,
                                env=self.environment | {"TERM": "dumb", "PAGES": str(self.pages / "zsh"), "LINE": line})
        shown = re.sub(r"\x1b\[[?0-9]*[a-zA-Z]", "", result.stdout).replace("\r", "\n").split("\n")
        lists = [text for text in shown if not re.match(rf"{re.escape(line)}|\s*$|READY|.*FINI", text)]
        return sorted(word for text in lists for word in re.split(r"\s\s+", text.strip()))

    def test_zsh_offers_the_same(self):
        self.assertEqual(self.zsh("exemplar", "label", ""), sorted(self.entries(self.helps["exemplar label"], "Subcommands")))
        for command in ["exemplar label train", "exemplar lines", "exemplar-viewer"]:
            with self.subTest(command):
                self.assertEqual(self.zsh(*command.split(), "--"),
                                 sorted(option for option in self.options(command) if option.startswith("--")))
        self.assertEqual(self.zsh("exemplar", "curvature", "train", "--bases", ""), ["ica", "pca"])
        self.assertEqual(self.zsh("exemplar", "lines", "--types", "contours,cr"), ["creases"])
        self.assertEqual(self.zsh("exemplar", "label", "apply", "--out", ""), ["folder/"])
        styles = self.zsh("exemplar", "lines", "--style", "")
        self.assertEqual([word for word in ["cow.off", "pencil"] if word not in styles], [], styles)


if __name__ == "__main__":
    unittest.main()
