"""Types: the package and its examples by mypy, the stubs of the Rust side by its stubtest."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PACKAGE = Path(__file__).parents[1]
# Names of the stubs alone, and signatures whose defaults PyO3 does not show.
STUBS_ALONE = ["__all__", "Buffer", "Problem", "Real", "Settings", "Whole"]
HIDDEN_DEFAULTS = ["trial", r"Library\.__new__", r"Simulator\.__new__"]


def run(*arguments):
    found = subprocess.run([sys.executable, "-m", *arguments], cwd=PACKAGE, capture_output=True, text=True, check=False)
    return found.returncode, found.stdout + found.stderr


class Types(unittest.TestCase):
    def test_the_package_and_its_examples_pass_mypy_strictly(self):
        code, text = run("mypy", "--strict", "--ignore-missing-imports", "-p", "onetwo")
        self.assertEqual(code, 0, text)
        code, text = run("mypy", "--strict", "--ignore-missing-imports", "examples")
        self.assertEqual(code, 0, text)

    def test_the_stubs_are_those_of_the_built_module(self):
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as allowed:
            allowed.write("".join(rf"onetwo\._native\.{name}" + "\n" for name in STUBS_ALONE + HIDDEN_DEFAULTS))
            allowed.flush()
            code, text = run("mypy.stubtest", "onetwo._native", "--allowlist", allowed.name, "--concise")
        self.assertEqual(code, 0, text)

    def test_a_wrong_call_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "wrong.py")
            file.write_text("import onetwo\nonetwo.Simulator(own='three')\nonetwo.Library().retrieve(3)\n")
            code, text = run("mypy", "--strict", str(file))
        self.assertEqual(code, 1)
        self.assertIn("own", text)
        self.assertIn("retrieve", text)


if __name__ == "__main__":
    unittest.main()
