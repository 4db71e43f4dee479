#!/usr/bin/env python3
"""Runs the tests of the Python package. The path of the program is in the environment variable KEYBLOCK.

Where pytest, numpy or h5py is missing the tests are skipped (exit code 77), unless CI is set.
"""

import importlib.util
import os
import sys
from pathlib import Path

SKIPPED = 77


def main() -> int:
    missing = [name for name in ("pytest", "numpy", "h5py") if importlib.util.find_spec(name) is None]
    if missing:
        print(f"not installed for {sys.executable}: {', '.join(missing)}", file=sys.stderr)
        return 1 if os.environ.get("CI") else SKIPPED
    import pytest

    return int(pytest.main(["-q", "-p", "no:cacheprovider", str(Path(__file__).parent), *sys.argv[1:]]))


if __name__ == "__main__":
    sys.exit(main())
