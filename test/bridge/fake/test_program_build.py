"""The library of the board's program: built from the source tree, by any compiler."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from bridge.fake import program_build
from bridge.fake.program_build import FIRMWARE, CannotCompile, build, is_stale, sources


def test_the_library_is_built_where_it_is_asked_for_and_nothing_else_is_left(tmp_path):
    output = tmp_path / 'board.so'
    build(output)
    assert [p.name for p in tmp_path.iterdir()] == ['board.so']
    assert not is_stale(output)


def test_it_is_stale_once_a_source_or_a_header_is_newer(tmp_path):
    firmware = tmp_path / 'firmware'
    for folder in program_build.FOLDERS:
        shutil.copytree(FIRMWARE / folder, firmware / folder)
    output = tmp_path / 'board.so'
    assert is_stale(output, firmware)
    output.touch()
    assert not is_stale(output, firmware)
    for name in ('core/board.c', 'core/hardware.h', 'host/target.h'):
        os.utime(output, (1, 1))
        os.utime(firmware / name, (2, 2))
        assert is_stale(output, firmware), name


def test_without_sources_the_library_that_is_there_is_taken(tmp_path):
    assert not is_stale(tmp_path / 'board.so', tmp_path)


def test_what_the_compiler_refuses_is_said_and_the_old_library_stays(tmp_path):
    (tmp_path / 'core').mkdir()
    (tmp_path / 'core' / 'wrong.c').write_text('int x = ;')
    output = tmp_path / 'board.so'
    output.write_text('old')
    with pytest.raises(CannotCompile, match=r'wrong\.c:1'):
        build(output, tmp_path)
    assert output.read_text() == 'old'
    assert sorted(p.name for p in tmp_path.iterdir()) == ['board.so', 'core']


def test_without_a_compiler_one_sentence_says_what_to_install(monkeypatch, tmp_path):
    monkeypatch.setenv('PATH', str(tmp_path))
    monkeypatch.delenv('CC', raising=False)
    monkeypatch.setattr(program_build.importlib.util, 'find_spec', lambda name: None)
    with pytest.raises(CannotCompile, match='no C compiler: install gcc or clang'):
        build(tmp_path / 'board.so')


def test_the_file_runs_by_itself_as_setup_does(tmp_path):
    """Nothing of ours and nothing that is not in Python's own library is imported."""
    code = (
        'import pathlib, runpy, sys\n'
        'runpy.run_path(sys.argv[1])["build"](pathlib.Path(sys.argv[2]))'
    )
    output = tmp_path / 'board.so'
    command = [sys.executable, '-I', '-S', '-c', code, program_build.__file__, str(output)]
    subprocess.run(command, check=True, cwd=tmp_path)
    assert output.exists()


def test_all_files_of_the_program_are_in_it():
    names = {path.relative_to(FIRMWARE).as_posix() for path in sources()}
    assert {'core/board.c', 'core/link.c', 'host/host.c'} <= names
    assert not any(Path(name).parts[0] == 'avr' for name in names)
