"""The package quadcore as a ROS workspace holds it: the services, and all else where that is.

The simulation itself is installed by pip, under the same name. A workspace comes before it on the
path; this file makes one package of the two, and lets the services work alone without the other.
"""

import pkgutil as _pkgutil
import sys as _sys
from pathlib import Path as _Path

__path__ = _pkgutil.extend_path(__path__, __name__)  # noqa: F821

for _folder in map(_Path, __path__):
    if (_folder / "simulation.py").is_file():
        exec(compile((_folder / "__init__.py").read_text(), str(_folder / "__init__.py"), "exec"))
        break
else:

    def __getattr__(name):
        """Say what is missing."""
        raise AttributeError(
            f"quadcore.{name}: the simulation is not installed for {_sys.executable}; "
            "pip install this package's folder, or activate the environment that has it"
        )
