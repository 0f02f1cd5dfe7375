"""What arguments of several functions are."""

import os
from collections.abc import Callable, Mapping
from typing import Any

Path = str | os.PathLike[str]
#: Called as ``progress(stage, done, total)``.
Progress = Callable[[str, int, int], object]
#: Settings by their names.
Options = Mapping[str, Any]
