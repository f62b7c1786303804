"""The notebook in docs, run from top to bottom."""

import unittest
from pathlib import Path

import nbformat
from nbclient import NotebookClient

NOTEBOOK = Path(__file__).parents[3] / "docs/notebooks/cases-and-pictures.ipynb"


class Notebook(unittest.TestCase):
    def test_every_cell_runs_and_the_last_ones_show_something(self):
        notebook = nbformat.read(NOTEBOOK, as_version=4)
        NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
        code = [cell for cell in notebook.cells if cell.cell_type == "code"]
        self.assertIn("image/svg+xml", code[3].outputs[0]["data"])
        self.assertRegex(code[4].outputs[0]["text"], r"^(goal|lost|out|time) after [\d.]+ s, \d+ frames of \(330, 480, 3\)")


if __name__ == "__main__":
    unittest.main()
