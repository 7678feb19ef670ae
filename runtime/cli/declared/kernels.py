"""``surefoot cache``: compiled kernels."""

import json
from typing import Annotated

import typer

from runtime.cli.declared.options import JsonOption


def cache(
    clear: Annotated[bool, typer.Option("--clear", help="Remove all compiled kernels.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Show where compiled kernels are kept and how much space they take, or remove them."""
    from surefoot.kernels import folder

    if clear:
        folder.clear()
    kept, size = folder.cache_folder(), folder.size_of_cache()
    if as_json:
        print(json.dumps({"folder": kept and str(kept), "bytes": size}))
    elif kept is None:
        print("nowhere: no cache folder is writable; set NUMBA_CACHE_DIR to one that is")
    else:
        print(f"{kept}: {size / 1e6:.1f} MB")
