"""The C libraries: built by any compiler, without Python's headers."""

import shutil

import pytest

import build_backend

KERNEL = build_backend.LIBRARIES['manipulator._kernel']


@pytest.fixture
def no_compiler(monkeypatch):
    monkeypatch.setattr(shutil, 'which', lambda name: None)


@pytest.mark.parametrize('name', build_backend.LIBRARIES)
def test_each_library_is_built_where_it_is_asked_for(tmp_path, name):
    output = tmp_path / 'new' / 'library.so'
    build_backend.build(name, output)
    assert output.read_bytes().startswith(b'\x7fELF')


def test_all_its_files_are_in_it_and_the_chips_are_not():
    board = build_backend.LIBRARIES['bridge._board'].files('*.c')
    assert {'firmware/core/board.c', 'firmware/core/link.c', 'firmware/host/host.c'} <= set(board)
    assert not any('avr' in name for name in board)
    assert {'kernel/crank.c', 'kernel/python.c'} <= set(KERNEL.files('*.c'))


def test_a_failed_build_is_one_sentence_that_says_what_to_install(monkeypatch, tmp_path):
    monkeypatch.setattr(build_backend, 'compiler', lambda: ['false'])
    with pytest.raises(SystemExit, match=r"did not compile with 'false' .* apt install gcc"):
        build_backend.build('bridge._board', tmp_path / 'library.so')


@pytest.mark.parametrize('what', ['wheel', 'editable'])
def test_where_there_is_no_compiler_pip_is_asked_for_one(no_compiler, what):
    required = getattr(build_backend, f'get_requires_for_build_{what}')()
    assert any(name.startswith('ziglang') for name in required)
    assert build_backend.compiler()[-2:] == ['ziglang', 'cc']


@pytest.mark.parametrize('what', ['wheel', 'editable'])
def test_the_systems_compiler_is_enough(what):
    required = getattr(build_backend, f'get_requires_for_build_{what}')()
    assert not any(name.startswith('ziglang') for name in required)
