"""The example of docs/examples runs to its end; skipped where the system's Python has no scikit-learn."""

import os
import pathlib
import subprocess
import sys

SKIPPED = 77
EXAMPLE = pathlib.Path(__file__).parents[2] / "docs/examples/features_with_sklearn.py"

try:
    import sklearn  # noqa: F401
except ImportError as error:
    print(f"skipped: {sys.executable} has no scikit-learn (Debian: python3-sklearn): {error}")
    sys.exit(SKIPPED)

run = subprocess.run([sys.executable, "-B", EXAMPLE], stdout=subprocess.PIPE, text=True, timeout=500,
                     env=dict(os.environ, EXAMPLE_FACES="800", EXAMPLE_SHAPES="3", EXAMPLE_ROUNDS="20"))
print(run.stdout)
rates = [float(line.split()[-2]) for line in run.stdout.splitlines() if line.startswith("mean")]
# Three coarse shapes teach little; that much they do. Chance, or labels of other faces, would give a third.
if run.returncode != 0 or len(rates) != 2 or min(rates) < 60:
    sys.exit(f"exit code {run.returncode}, rates {rates}: two above 60 were expected")
