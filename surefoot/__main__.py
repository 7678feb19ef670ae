"""``python -m surefoot`` runs the command where its script is not on the path."""

from runtime.cli.app import main

main()
