"""Whether what is to be restored can be the state of a body: asked before anything is changed by it.

A saved state may come out of a file, and compiled code uses some of its numbers as indices. What is asked
here is that nothing breaks, not that the state was ever reached.
"""
