"""The same problems solved by others: one library a file, in turns with ours.

A library that is not installed costs its file's rows, and nothing else.
"""
