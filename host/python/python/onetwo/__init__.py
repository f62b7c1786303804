"""Case-based robot soccer from Python: retrieval and its explanation, trials, and a Small Size simulator.

`retrieve`, `explain` and `trial` return what `onetwo cases retrieve`, `onetwo cases explain --json` and
`onetwo trial --json` print, as dicts. `Simulator` plays Small Size episodes step by step. None of these needs another
package; `onetwo.env` is a Gymnasium environment and needs `gymnasium` and `numpy`.
"""

from ._native import VERSION as __version__
from ._native import Library, Simulator, explain, retrieve, trial

__all__ = ["Library", "Simulator", "__version__", "explain", "retrieve", "trial"]
