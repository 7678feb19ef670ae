"""Makes `benchmarks` importable: the corridors of the benchmark are the tests' corridors too."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
