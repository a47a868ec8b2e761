"""The shipped gamepad process, on machines that have no evdev or no pad."""

import pytest

pytestmark = pytest.mark.graph


def test_missing_library_is_one_line_and_status_1(refusal, tmp_path, monkeypatch):
    (tmp_path / 'evdev.py').write_text('raise ModuleNotFoundError("gone", name="evdev")\n')
    monkeypatch.setenv('PYTHONPATH', str(tmp_path))
    status, text = refusal('gamepad')
    assert status == 1
    assert text.startswith('gamepad: needs the Python module evdev: python3 -m pip install evdev')
    assert len(text.splitlines()) == 1


def test_machine_without_the_pad_reports_that_and_goes_on_looking(
    running, listening, tmp_path, monkeypatch
):
    opener = 'def InputDevice(path, readonly):\n    raise FileNotFoundError(2, path)\n'
    (tmp_path / 'evdev.py').write_text(opener)
    monkeypatch.setenv('PYTHONPATH', str(tmp_path))
    with (
        running('gamepad', 'padless', device='/dev/input/event99') as process,
        listening('padless', 'joy') as listener,
    ):
        name = 'padless/gamepad'
        listener.wait('diagnostics', lambda: name in listener.diagnostics)
        assert 'no gamepad found' in listener.diagnostics[name].message
        process.terminate()
        assert process.wait(60) == 0
