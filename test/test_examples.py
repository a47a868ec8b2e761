"""Every script in examples/ explains itself; what it does, test/graph/hexapod tries."""

import runpy
from pathlib import Path

import pytest

pytest.importorskip('rclpy')

EXAMPLES = sorted((Path(__file__).resolve().parents[1] / 'examples').glob('*.py'))


@pytest.mark.parametrize('example', EXAMPLES, ids=lambda path: path.stem)
def test_example_explains_itself(example, monkeypatch, capsys):
    monkeypatch.setattr('sys.argv', [str(example), '--help'])
    monkeypatch.syspath_prepend(example.parent)
    with pytest.raises(SystemExit, match='0'):
        runpy.run_path(str(example), run_name='__main__')
    text = capsys.readouterr().out
    first_line = example.read_text().splitlines()[0].strip('"')
    assert first_line in ' '.join(text.split())
    assert '--namespace' in text
