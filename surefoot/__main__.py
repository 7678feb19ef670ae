"""``python -m surefoot``: the command, where no script of this name is on the path."""

from runtime.cli import main

main()
