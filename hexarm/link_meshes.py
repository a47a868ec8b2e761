"""The meshes that show an arm's links: binary STL files beside its machine file.

In metres and base axes at zero angles, so that each moves by its link's displacement.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexarm.machines import find, read
from manipulator.errors import ConfigError
from manipulator.formatting import counted, reason, shortened

HEADER = 84
FACET = np.dtype([('normal', '<f4', 3), ('corners', '<f4', (3, 3)), ('attribute', '<u2')])
MOST_FACES = 100_000
"""Of a link: what a browser shows seven of; MuJoCo reads 200,000."""
MOST_BYTES = HEADER + MOST_FACES * FACET.itemsize
SMALLEST = 1e-10
"""Twice the area of a link, m²."""
FARTHEST = 1000.0
"""Metres: a mesh in millimetres, or of noise, is no link."""

Triangles = NDArray[np.float32]
"""Corners (n, 3, 3), metres, counterclockwise from outside."""


@dataclass(frozen=True, eq=False)
class LinkMesh:
    """A link's mesh, and the file that it is from."""

    file: Path
    triangles: Triangles


def link_meshes(
    geometry: Mapping[str, Any], folder: Path
) -> tuple[tuple[LinkMesh | None, ...], list[str]]:
    """Of the base and the six links, None for a rod; and one sentence for each unusable file.

    geometry is the section of a machine file in `folder`; () for a machine without meshes.
    """
    found, faults = list[LinkMesh | None](), list[str]()
    for name in geometry.get('meshes') or ():
        mesh = None
        if name:
            file = (folder / name).absolute()
            try:
                mesh = LinkMesh(file, read_stl(file))
            except ConfigError as error:
                faults.append(f'geometry.meshes: {error}: its link is drawn as a rod')
        found.append(mesh)
    return tuple(found), faults


def meshes_of(name_or_path: str) -> tuple[tuple[LinkMesh | None, ...], list[str]]:
    """`link_meshes` of a machine; ConfigError as `machines.read`."""
    return link_meshes(read(name_or_path).geometry, find(name_or_path).parent)


def read_stl(file: Path) -> Triangles:
    """A binary STL file; ConfigError for what is none, is huge, or has no surface."""
    content = bytes_of(file, MOST_BYTES)
    count = int.from_bytes(content[80:HEADER], 'little')
    if len(content) < HEADER or len(content) != HEADER + count * FACET.itemsize:
        raise ConfigError(['is no binary STL'], named(file))
    triangles: Triangles = np.frombuffer(content, FACET, offset=HEADER)['corners']
    try:
        check(triangles)
    except ConfigError as error:
        raise ConfigError(error.problems, named(file)) from error
    return triangles


def write_stl(file: Path, triangles: Triangles) -> None:
    """A binary STL file; OSError where it cannot be written."""
    facets = np.zeros(len(triangles), FACET)
    facets['corners'] = triangles
    head = b'hexarm: metres, base axes at zero angles'.ljust(80)
    file.write_bytes(head + len(triangles).to_bytes(4, 'little') + facets.tobytes())


def check(triangles: Triangles) -> None:
    """ConfigError for too many faces, for no surface, and for corners that no machine has."""
    if not 0 < len(triangles) <= MOST_FACES:
        faces = counted(len(triangles), 'face')
        raise ConfigError([f'has {faces}, 1 to {MOST_FACES:,} of a link are drawn'])
    if not (np.abs(triangles) <= FARTHEST).all():
        raise ConfigError([f'has corners farther than {FARTHEST:g} m: is it in another unit?'])
    a, b, c = triangles.transpose(1, 0, 2).astype(np.float64)
    doubled = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    corners = triangles.reshape(-1, 3)
    has_others = (corners[:, None] != triangles[doubled.argmax()]).any(axis=2).all(axis=1).any()
    if doubled.sum() < SMALLEST or not has_others:  # which MuJoCo refuses
        raise ConfigError(['is no surface but a triangle, a line or a point'])


def bytes_of(file: Path, most: int) -> bytes:
    """What a file holds; ConfigError where it is missing, cannot be read, or is huge."""
    content = None
    try:
        if file.is_file():  # no device, which may never end
            with file.open('rb') as opened:
                content = opened.read(most + 1)
        why = 'is a folder or a device' if file.exists() else 'does not exist'
    except (OSError, ValueError) as error:
        why = f'cannot be read: {reason(error)}'
    if content is None:
        raise ConfigError([why], named(file))
    if len(content) > most:
        raise ConfigError([f'is larger than {most // 1_000_000} MB'], named(file))
    return content


def named(file: Path) -> str:
    """A path in a message: on one line, and not too long."""
    return shortened(' '.join(str(file).split()), 300)
