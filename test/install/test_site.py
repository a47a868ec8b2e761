"""The documents as a web site: all links lead somewhere, every document is in the navigation."""

import sys

PAGES = ('.', 'reference', 'interfaces', 'changelog')


def test_the_site_is_built_without_a_warning(source, run, tmp_path):
    run(sys.executable, '-m', 'mkdocs', 'build', '--strict', '-q', '-d', tmp_path, cwd=source)
    for name in PAGES:
        assert (tmp_path / name / 'index.html').is_file()
    reference = (tmp_path / 'reference' / 'index.html').read_text()
    assert 'id="hexarm.robot.Robot.move_to"' in reference
