"""Pages of the web site that are not files in docs/: mkdocs.yml.

README.md is the first page; the Python reference is made from docstrings.
"""

import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parent.parent
PAGES = {'README.md': 'index.md', 'CONTRIBUTING.md': 'contributing.md'}
PAGES['CHANGELOG.md'] = 'changelog.md'

PUBLIC = (
    ('The client', ('hexarm.robot.Robot', 'hexarm.robot_values.Limits')),
    ('Errors', ('manipulator.errors',)),
    ('Poses', ('manipulator.pose.Pose', 'manipulator.saved_poses.SavedPoses')),
    ('Machines', ('hexarm.machines', 'manipulator.machine.Machine')),
    ('Kinematics', ('manipulator.kinematics',)),
    ('Analysis', ('manipulator.analysis.reach', 'manipulator.analysis.accuracy')),
)
"""Modules and classes for programs, by heading; docs/client.md introduces them."""


def on_files(files: Files, config: Any) -> Files:
    """Adds the pages."""
    for name, page in PAGES.items():
        files.append(File.generated(config, page, content=page_text((ROOT / name).read_text())))
    files.append(File.generated(config, 'reference.md', content=reference()))
    return files


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Links to files that are no pages, as in ../config, become plain words."""
    return re.sub(r'\[([^\]]*)\]\(\.\./[^)]*\)', r'\1', markdown)


def page_text(text: str) -> str:
    """The text of a file above docs/ as a page: its links lead to pages, or are plain words."""
    for name, page in PAGES.items():
        text = text.replace(f']({name})', f']({page})')
    text = re.sub(r'\]\(docs/', '](', text)
    return re.sub(r'\[([^\]]*)\]\((?:[\w./-]+/|LICENSE)\)', r'\1', text)


def reference() -> str:
    """The page that mkdocstrings fills."""
    lines = [
        '# Python reference',
        '',
        'Metres, radians, seconds; poses are in the base frame.',
        '',
    ]
    for heading, names in PUBLIC:
        lines += [f'## {heading}', '', *(f'::: {name}\n' for name in names)]
    return '\n'.join(lines)
