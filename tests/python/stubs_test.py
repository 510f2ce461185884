"""The typed stub says what the compiled module has: names, arguments and which of them have defaults; all is documented."""

import ast
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import exemplar

STUB = pathlib.Path(exemplar.__file__).with_suffix(".pyi")


def is_public(name):
    return not name.startswith("_") or name in ("__init__", "__version__")


def arguments_of(function):
    """[(name, kind, whether it has a default)] of a parsed function."""
    arguments = function.args
    positional = arguments.posonlyargs + arguments.args
    plain = len(positional) - len(arguments.defaults)
    return ([(argument.arg, "positional", i >= plain) for i, argument in enumerate(positional)] +
            [(argument.arg, "keyword", default is not None)
             for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults)])


def compiled_arguments(function):
    """The same, from the line that begins the documentation of a compiled function."""
    line = function.__doc__.split("\n")[0]
    name = line[:line.index("(")]
    return arguments_of(ast.parse(f"def {line}: ...").body[0]), name


def stub_members(body):
    """{name: "property", arguments or "value"} of a module or class."""
    members = {}
    for node in body:
        if isinstance(node, ast.FunctionDef):
            decorators = {decorator.id for decorator in node.decorator_list}
            members[node.name] = "property" if "property" in decorators else arguments_of(node)
        elif isinstance(node, ast.ClassDef):
            members[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            members[node.target.id] = "value"
    return {name: member for name, member in members.items() if is_public(name)}


def compiled_members(names, owner):
    members = {}
    for name in names:
        value = getattr(owner, name)
        if isinstance(value, property):
            members[name] = "property"
        elif isinstance(value, type):
            members[name] = value
        elif callable(value):
            members[name] = compiled_arguments(value)[0]
        else:
            members[name] = "value"
    return members


class StubTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.stub = stub_members(ast.parse(STUB.read_text()).body)
        cls.module = compiled_members(filter(is_public, exemplar.__all__), exemplar)

    def classes(self):
        for name, value in self.module.items():
            if isinstance(value, type) and not issubclass(value, BaseException):
                yield name, value

    def test_the_package_has_all_of_the_compiled_module(self):
        compiled = {name for name in dir(exemplar._exemplar) if is_public(name) and name != "__init__"}
        self.assertEqual(compiled, set(exemplar.__all__))

    def test_names_and_arguments_of_functions(self):
        self.assertEqual(set(self.stub), set(self.module))
        for name, member in self.module.items():
            if not isinstance(member, type):
                self.assertEqual(self.stub[name], member, name)

    def test_names_and_arguments_of_methods(self):
        for name, value in self.classes():
            has_init = value.__init__.__doc__.startswith("__init__(")  # the others are made by functions only
            compiled = compiled_members((member for member in vars(value)
                                         if is_public(member) and (member != "__init__" or has_init)), value)
            self.assertEqual(stub_members(self.stub[name].body), compiled, name)

    def test_bases_of_errors(self):
        for name, value in self.module.items():
            if isinstance(value, type) and issubclass(value, BaseException):
                self.assertEqual([base.id for base in self.stub[name].bases],
                                 [base.__name__ for base in value.__bases__], name)

    def test_all_is_documented(self):
        for name, value in self.module.items():
            self.assertTrue(getattr(exemplar, name).__doc__, name)
            if isinstance(value, list):
                self.assertGreater(len(getattr(exemplar, name).__doc__.split("\n")), 2, name)
        for name, value in self.classes():
            for member, compiled in vars(value).items():
                if is_public(member):
                    words = compiled.__doc__ if isinstance(compiled, property) else getattr(value, member).__doc__
                    self.assertGreater(len(words.split("\n", 2)[-1]), 10, f"{name}.{member}")

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed (Debian: mypy)")
    def test_a_type_checker_takes_it(self):
        user = ("import exemplar\n"
                "mesh = exemplar.Mesh([(0, 0, 0)], [(0, 0, 0)])\n"
                "model = exemplar.train_labeling([mesh], rounds=3, orientation='no')\n"
                "wrong: int = model.label(mesh).labels\n"
                "exemplar.features(mesh, sample=3)\n")
        with tempfile.TemporaryDirectory(prefix="exemplar-mypy-") as folder:
            path = pathlib.Path(folder) / "user.py"
            path.write_text(user)
            checked = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", folder, str(path)],
                                     env=dict(os.environ, MYPYPATH=str(STUB.parents[1])), text=True,
                                     stdout=subprocess.PIPE, timeout=300)
        self.assertIn("user.py:4: error", checked.stdout)
        self.assertIn("user.py:5: error", checked.stdout)
        self.assertIn("Found 2 errors in 1 file", checked.stdout)


if __name__ == "__main__":
    unittest.main()
