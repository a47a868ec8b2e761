"""Runs all bench modules, or those named, and prints one table; status 1 for a goal missed.

`--write FILE` makes the page FILE (Markdown) of the same run.
"""

import argparse
import sys
from pathlib import Path

from bench.computer import this_computer
from bench.page import page, table
from bench.section import measured, names
from bench.stall_watch import StallWatch


def main(arguments: list[str]) -> int:
    known = names()
    parser = argparse.ArgumentParser(prog='python -m bench', description=__doc__)
    parser.add_argument('names', nargs='*', metavar='NAME', help=', '.join(known))
    parser.add_argument('--write', type=Path, metavar='FILE', help='the page to write')
    options = parser.parse_args(arguments)
    unknown = [name for name in options.names if name not in known]
    if unknown:
        parser.error(f'nothing measures {", ".join(unknown)}; there are {", ".join(known)}')
    chosen, computer, sections = options.names or known, this_computer(), []
    with StallWatch() as stalls:
        for count, name in enumerate(chosen, start=1):
            print(f'[{count}/{len(chosen)}] {name}', file=sys.stderr, flush=True)
            sections.append(measured(name))
        computer['longest time that the host took a core away'] = stalls.summary
    print(table(computer, sections))
    if options.write:
        options.write.write_text(page(computer, sections))
        print(f'written: {options.write}')
    return 0 if all(row.reached for section in sections for row in section.rows) else 1


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
