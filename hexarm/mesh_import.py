"""The meshes that a URDF names, as the files that a machine file names: `link_meshes`.

Formats are what trimesh reads: STL, OBJ, PLY, OFF, glTF, and COLLADA (.dae) where pycollada is.
"""

import io
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from arm_control.urdf_file import Visual
from hexarm.link_meshes import MOST_FACES, Triangles, bytes_of, check, named, write_stl
from manipulator.arrays import Array
from manipulator.errors import ConfigError, InvalidInput
from manipulator.formatting import counted, reason, shown

MOST_BYTES = 50_000_000
MOST_NAMED = 12
"""Meshes that are not imported."""
FORMATS = ('stl', 'obj', 'dae', 'ply', 'off', 'glb')
INSTALL = "pip install 'hexarm[meshes]'"
LINKS = ('base', *(f'link_{i}' for i in range(1, 7)))


@dataclass(frozen=True)
class Packages:
    """Where meshes are searched: of_name are folders of ROS packages, urdf the URDF's file."""

    of_name: Mapping[str, Path]
    urdf: Path

    def file(self, name: str) -> Path:
        """The file of a URDF's name for it; ConfigError says where it was searched for."""
        scheme, _, rest = name.rpartition('://')
        if scheme in ('package', 'model'):
            package, _, inside = rest.partition('/')
            return self._in_package(name, package, inside)
        if scheme not in ('', 'file'):
            raise ConfigError([f'{shown(name)} is no file of this computer'])
        return self.urdf.absolute().parent / rest

    def _in_package(self, name: str, package: str, inside: str) -> Path:
        folders = list(self._folders(package))
        found = next((f / inside for f in folders if (f / inside).is_file()), None)
        if found is not None:
            return found
        if folders:
            return folders[0] / inside
        raise ConfigError(
            [f'meshes of package {shown(package)}, which is not found: --package NAME=DIR']
        )

    def _folders(self, package: str) -> Iterator[Path]:
        """By --package alone, or by the environment of ROS, or beside and above the URDF."""
        if package in self.of_name:
            yield self.of_name[package]
            return
        ros, ament = _paths('ROS_PACKAGE_PATH'), _paths('AMENT_PREFIX_PATH')
        above = self.urdf.absolute().parents
        candidates = [*ros, *(folder / package for folder in ros)]
        candidates += [prefix / 'share' / package for prefix in ament]
        candidates += [*above, *(folder / package for folder in above)]
        yield from (f for f in candidates if f.name == package and f.is_dir())


def packages_of(options: Sequence[str]) -> dict[str, Path]:
    """Of options NAME=DIR; InvalidInput for another text, and for what is no folder."""
    found = {}
    for option in options:
        name, _, folder = option.partition('=')
        if not name or not os.path.isdir(folder):
            raise InvalidInput(f'--package {shown(option)}: needs NAME=DIR, DIR a folder')
        found[name] = Path(folder)
    return found


def _paths(variable: str) -> list[Path]:
    return [Path(path) for path in os.environ.get(variable, '').split(os.pathsep) if path]


@dataclass(frozen=True, eq=False)
class ImportedMeshes:
    """Of the base and the six links, None where there is none; and a sentence for each fault."""

    triangles: tuple[Triangles | None, ...]
    faults: tuple[str, ...]

    def names(self, folder: str) -> list[str]:
        """Of the files in a folder beside the machine file, '' for no mesh; [] for none at all."""
        names = [
            '' if mesh is None else f'{folder}/{link}.stl'
            for link, mesh in zip(LINKS, self.triangles, strict=True)
        ]
        return names if any(names) else []

    def write(self, folder: Path) -> None:
        """All files; InvalidInput where one cannot be written, or the folder is there."""
        try:
            folder.mkdir()
            for link, mesh in zip(LINKS, self.triangles, strict=True):
                if mesh is not None:
                    write_stl(folder / f'{link}.stl', mesh)
        except FileExistsError:
            raise InvalidInput(f'{folder} exists: another name with --output') from None
        except OSError as error:
            raise InvalidInput(f'cannot write {folder}: {reason(error)}') from error


def imported_meshes(
    visuals: Sequence[Sequence[Visual]], file_of: Callable[[str], Path]
) -> ImportedMeshes:
    """The meshes of each link as one, in base axes at zero; a link with a fault keeps the rest."""
    faults, links = list[str](), list[Triangles | None]()
    for link, of_link in zip(LINKS, visuals, strict=True):
        parts = list[Triangles]()
        for visual in of_link:
            try:
                parts.append(_placed(visual, _triangles(file_of(visual.file))))
            except ConfigError as error:
                faults.append(f'not imported: {error}')
        links.append(_whole(link, parts, faults))
    once = list(dict.fromkeys(faults))
    more = [f'and {counted(len(once) - MOST_NAMED, "more mesh", "more meshes")}']
    return ImportedMeshes(
        tuple(links), tuple(once if len(once) <= MOST_NAMED else once[:MOST_NAMED] + more)
    )


def _whole(link: str, parts: Sequence[Triangles], faults: list[str]) -> Triangles | None:
    """A link's meshes as one; None, and a fault, where that is too large."""
    if not parts:
        return None
    whole: Triangles = np.concatenate(parts)
    try:
        check(whole)
    except ConfigError as error:
        faults.append(f'not imported: meshes of {link}, together: {error}')
        return None
    return whole


def _placed(visual: Visual, triangles: Array) -> Triangles:
    """In base axes; a mirrored mesh keeps its outside."""
    moved = visual.place.transform((triangles * visual.scale).reshape(-1, 3)).reshape(-1, 3, 3)
    if np.prod(visual.scale) < 0:
        moved = moved[:, ::-1]
    return moved.astype(np.float32)


def _triangles(file: Path) -> Array:
    """Corners (n, 3, 3) of a mesh file, in its units; COLLADA's in metres, axes as they are."""
    kind = file.suffix.lower().lstrip('.')
    if kind not in FORMATS:
        raise ConfigError([f'is none of {", ".join(FORMATS)}'], named(file))
    content = bytes_of(file, MOST_BYTES)
    corners = _parsed(kind, content, named(file))
    if not 0 < len(corners) <= MOST_FACES:
        faces = counted(len(corners), 'face')
        raise ConfigError([f'has {faces}, 1 to {MOST_FACES:,} of a link are drawn'], named(file))
    if not np.isfinite(corners).all():
        raise ConfigError(['has corners that are not finite'], named(file))
    return corners


def _parsed(kind: str, content: bytes, name: str) -> Array:
    """All triangles of a file's scene, which may be none."""
    try:
        import trimesh  # noqa: PLC0415 (an extra)
    except ImportError:
        raise ConfigError([f'meshes need trimesh: {INSTALL}']) from None
    if kind not in trimesh.exchange.load.mesh_formats():
        raise ConfigError([f'.{kind} meshes need pycollada: {INSTALL}'])
    parts = [np.empty((0, 3, 3))]
    try:
        scene = trimesh.load_scene(
            io.BytesIO(content), file_type=kind, process=False, skip_materials=True
        )
        for matrix, mesh in map(scene.graph.get, scene.graph.nodes_geometry):
            solid = scene.geometry[mesh]
            if isinstance(solid, trimesh.Trimesh):
                corners = trimesh.transform_points(solid.triangles.reshape(-1, 3), matrix)
                parts.append(_unit(solid.metadata) * corners.reshape(-1, 3, 3))
    except Exception as error:
        why = ' '.join(str(error).split())[:120] or type(error).__name__
        raise ConfigError([f'cannot be read: {why}'], name) from error
    return np.concatenate(parts)


def _unit(metadata: Mapping[str, str]) -> float:
    """Metres in a unit of COLLADA, which trimesh writes as '0.001 * meters'; 1 for others."""
    number, times, _ = str(metadata.get('units', '')).partition(' * ')
    return float(number) if times else 1.0
