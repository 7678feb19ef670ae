"""``python -m surefoot``: the command, where no script of this name is on the path."""

from runtime.cli.app import main

main()
