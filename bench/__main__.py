"""Runs all bench modules, or those named, and prints one table; status 1 for a goal missed."""

import importlib
import pkgutil
import sys

import bench


def main(names: list[str]) -> int:
    found = []
    for module in pkgutil.iter_modules(bench.__path__):
        if names and module.name not in names:
            continue
        if module.name != '__main__':
            rows = getattr(importlib.import_module(f'bench.{module.name}'), 'rows', None)
            found += rows() if rows else []
    widths = [max(len(text) for text in column) for column in zip(*map(cells, found), strict=True)]
    for row in found:
        print(
            '  '.join(text.ljust(w) for text, w in zip(cells(row), widths, strict=True)).rstrip()
        )
    return 0 if all(row.reached for row in found) else 1


def cells(row):
    goal = f'goal {row.goal}' if row.goal else ''
    return row.name, row.value, goal, '' if row.reached else 'MISSED'


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
