"""Third-party integrators for the rolling ellipse, one file per library.

`available()` imports the installed libraries; importing this package alone does not.
"""

import importlib
import warnings
from typing import Any

MODULES = {  # library that each module needs; boost_odeint looks for Boost and g++ itself
    "scipy_ivp": "scipy",
    "numba_pairs": "numbalsoda",
    "heyoka_taylor": "heyoka",
    "boost_odeint": "Boost.odeint",
    "rebound_ode": "rebound",
    "diffrax_pairs": "diffrax",
    "sundials": "scikit-sundae",
}


def available() -> tuple[list[Any], dict[str, str]]:
    """The installed peers, and the reason for each missing library."""
    found, missing = [], {}
    for module, library in MODULES.items():
        try:
            # libraries emit warnings while they load
            with warnings.catch_warnings(action="ignore"):
                found += importlib.import_module(f".{module}", __name__).peers()
        except ModuleNotFoundError as error:
            missing[library] = f"{error.name} is not installed"
        except Exception as error:  # a broken installation may raise any exception
            missing[library] = f"{type(error).__name__}: {error}"
    return found, missing
