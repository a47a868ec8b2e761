"""Texts of shipped machine files, and changes of them."""

from pathlib import Path

CONFIG = Path(__file__).parents[2] / 'config'
REAL = Path(__file__).parents[1] / 'hexarm' / 'machines'
ROBOCAKE = (CONFIG / 'robocake.yaml').read_text()
ARM = (CONFIG / 'arm_6r.yaml').read_text()
STEWART = (CONFIG / 'stewart_6_3.yaml').read_text()
UR5 = (CONFIG / 'ur5.yaml').read_text()
STACK = (CONFIG / 'stack_6_6.yaml').read_text()
BY_COORDINATES = (CONFIG / 'reachy_mini.yaml').read_text()


def changed(text, *replacements):
    for old, new in replacements:
        assert old in text, old
        text = text.replace(old, new)
    return text
