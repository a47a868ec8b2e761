"""`hexarm plot FILE`: a recording as a picture or as tables; needs no ROS."""

import argparse
from pathlib import Path

import numpy as np

from hexarm.cli.answers import Answer, answering, picture_file
from hexarm.namespaces import namespace_of
from manipulator.errors import InvalidInput
from manipulator.formatting import counted
from manipulator.states import MotionResult


def add_parser(commands: 'argparse._SubParsersAction[argparse.ArgumentParser]') -> None:
    """Declares the subcommand."""
    parser = commands.add_parser('plot')
    parser.add_argument('file', type=Path, metavar='FILE', help='an MCAP recording, or its folder')
    parser.add_argument(
        '-o', '--output', type=picture_file, metavar='PICTURE', help='default: FILE with .png'
    )
    parser.add_argument(
        '--from', type=float, dest='begin', metavar='S', help='seconds since its beginning'
    )
    parser.add_argument('--to', type=float, dest='end', metavar='S', help='likewise')
    parser.add_argument('--namespace', type=namespace_of, help='where it holds several machines')
    parser.add_argument(
        '--csv', type=Path, metavar='FOLDER', help='tables into a folder, instead of a picture'
    )
    parser.add_argument('--json', action='store_true', help='answer for programs')
    parser.set_defaults(run=answering(answer))


def answer(arguments: argparse.Namespace) -> Answer:
    """Writes picture or tables; the answer is the figures of the recording, and where it is."""
    from hexarm.recording.log_parser import is_needed, summarise  # noqa: PLC0415
    from hexarm.recording.reading import messages, write  # noqa: PLC0415 (needs mcap)

    summary = summarise(messages(arguments.file, is_needed), arguments.namespace)
    begin, end = _span(arguments.begin, arguments.end, summary.duration)
    part = summary.between(begin, end)
    if arguments.csv is not None:
        files = write(part, arguments.csv)
    else:
        from hexarm.recording.picture import draw  # noqa: PLC0415 (needs matplotlib)

        picture = arguments.output or arguments.file.with_suffix('.png')
        draw(summary, begin, end, picture)
        files = [picture]
    distance, angle = part.pose_error.values.T
    refused = sum(e.count for e in part.events if e.what == MotionResult.REFUSED)
    figures = {
        'namespace': summary.namespace,
        'seconds': round(end - begin, 3),
        'setpoints': len(part.setpoint),
        'poses': len(part.pose),
        'refused': refused,
        'error_rms_mm': _rms(1e3 * distance),
        'error_rms_deg': _rms(np.degrees(angle)),
    }
    lines = [
        f'/{summary.namespace}, {end - begin:.1f} s: {counted(len(part.setpoint), "setpoint")}, '
        f'{counted(len(part.pose), "pose")}, {refused} refused',
        *([f'pose behind setpoint: {figures["error_rms_mm"]:.3f} mm rms, '
           f'{figures["error_rms_deg"]:.3f}° rms'] if len(distance) else []),
        *map(str, files),
    ]  # fmt: skip
    return figures | {'files': list(map(str, files))}, lines


def _span(begin: float | None, end: float | None, duration: float) -> tuple[float, float]:
    """From where to where; InvalidInput for what lies outside of the recording."""
    begin, end = begin or 0.0, duration if end is None else min(end, duration)
    if not 0.0 <= begin < end:
        raise InvalidInput(f'from {begin:g} to {end:g} s: the recording has {duration:.1f} s')
    return begin, end


def _rms(values: np.ndarray) -> float | None:
    return round(float(np.sqrt(np.mean(values**2))), 6) if len(values) else None
