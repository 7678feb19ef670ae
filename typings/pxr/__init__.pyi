from typing import Any

Gf: Any
Tf: Any
Usd: Any
UsdGeom: Any
UsdSkel: Any
