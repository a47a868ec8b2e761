"""The examples are as short as they promise; what they do, test/graph/hexapod tries."""

import ast
import json
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / 'examples'


@pytest.mark.parametrize('example', sorted(EXAMPLES.glob('*.py')), ids=lambda path: path.stem)
def test_an_example_explains_itself_and_is_short(example):
    text = example.read_text()
    assert ast.get_docstring(ast.parse(text))
    assert len(text.splitlines()) <= 25


def test_the_notebook_ships_without_outputs():
    (path,) = EXAMPLES.glob('*.ipynb')
    cells = json.loads(path.read_text())['cells']
    assert cells[0]['cell_type'] == 'markdown'
    assert not any(cell.get('outputs') for cell in cells)
