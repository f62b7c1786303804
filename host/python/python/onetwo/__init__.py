"""Case-based robot soccer from Python: retrieval and its explanation, trials, and a Small Size simulator.

`retrieve`, `explain` and `trial` return what `onetwo cases retrieve`, `onetwo cases explain --json` and
`onetwo trial --json` print, as dicts. `Simulator` plays Small Size episodes step by step, `VectorSimulator` many at once.
None of these needs another package; `onetwo.env` has Gymnasium environments and needs `gymnasium` and `numpy`,
`onetwo.parallel` has PettingZoo's and needs `pettingzoo` too, `onetwo.cases` has what takes many problems or whole libraries
and needs `numpy`.
"""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType

from ._native import VERSION as __version__
from ._native import Library, Simulator, VectorSimulator, explain, retrieve, trial

__all__ = ["Library", "Simulator", "VectorSimulator", "__version__", "explain", "retrieve", "trial"]


class _Registration:
    """Registers the environments when gymnasium is imported later: importing onetwo need not import it."""

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if name != "gymnasium":
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        if spec is not None and spec.loader is not None:
            execute = spec.loader.exec_module

            def execute_and_register(module: ModuleType) -> None:
                execute(module)
                importlib.import_module("onetwo.env")

            setattr(spec.loader, "exec_module", execute_and_register)
        return spec


if "gymnasium" in sys.modules:
    importlib.import_module("onetwo.env")
else:
    sys.meta_path.insert(0, _Registration())
