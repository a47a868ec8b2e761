"""What of control_msgs the tests need, generated from its public definitions and compiled.

ROS wheels contain no control_msgs, but the generators of messages. They write C and C++, which
becomes one library; under the names of two type supports the middleware finds the same symbols.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np

NAME = 'control_msgs'
DEFINITIONS = Path(__file__).parent / NAME
PREFIX = Path(sys.prefix)
DEPENDENCIES = (
    'action_msgs', 'builtin_interfaces', 'std_msgs', 'trajectory_msgs', 'geometry_msgs',
    'unique_identifier_msgs', 'service_msgs',
)  # fmt: skip
KINDS = (
    'rosidl_generator_c', 'rosidl_generator_py', 'rosidl_typesupport_c',
    'rosidl_typesupport_fastrtps_c', 'rosidl_typesupport_introspection_c',
)  # fmt: skip
DISPATCHED = ['rosidl_typesupport_fastrtps_c', 'rosidl_typesupport_introspection_c']
RUNTIME = (
    'rosidl_runtime_c', 'rosidl_typesupport_c', 'rosidl_typesupport_fastrtps_c',
    'rosidl_typesupport_fastrtps_cpp', 'rosidl_typesupport_introspection_c', 'fastcdr', 'rmw',
    'rcutils',
)  # fmt: skip


def missing():
    """What this computer lacks to make it, '' for nothing."""
    if not (PREFIX / 'share' / 'rosidl_generator_py').is_dir():
        return 'the generators of ROS messages in this environment'
    return '' if shutil.which('g++') else 'g++'


def built(folder):
    """The folder from which `import control_msgs` works; made at the first call: 3 s of a core."""
    folder = Path(folder)
    done = folder / 'done'
    if not done.exists():
        shutil.rmtree(folder / NAME, ignore_errors=True)
        _generate(folder)
        _compile(folder)
        done.touch()
    return folder


def _generate(folder):
    os.environ.setdefault('AMENT_PREFIX_PATH', str(PREFIX))
    from rosidl_adapter.cli import TranslateActionToIDL, TranslateMsgToIDL  # noqa: PLC0415
    from rosidl_generator_c.cli import GenerateC  # noqa: PLC0415
    from rosidl_generator_py.cli import GeneratePython  # noqa: PLC0415
    from rosidl_generator_type_description.cli import HashTypeDescription  # noqa: PLC0415
    from rosidl_typesupport_c.cli import GenerateCTypesupport  # noqa: PLC0415
    from rosidl_typesupport_fastrtps_c.cli import GenerateFastRTPSCTypesupport  # noqa: PLC0415
    from rosidl_typesupport_introspection_c.cli import (  # noqa: PLC0415
        GenerateIntrospectionCTypesupport,
    )

    out, share = folder / NAME, [str(PREFIX / 'share')]
    idl = []
    for translator, kind in ((TranslateMsgToIDL, 'msg'), (TranslateActionToIDL, 'action')):
        files = sorted(DEFINITIONS.glob(f'{kind}/*.{kind}'))
        named = [f'{DEFINITIONS}:{file.relative_to(DEFINITIONS)}' for file in files]
        idl += translator(kind).translate(NAME, named, share, out / 'idl')
    hashes = HashTypeDescription('hash').generate_type_hashes(NAME, idl, share, out)
    GenerateC('c').generate(NAME, idl, share, out, hashes)
    for generator, place in (
        (GenerateFastRTPSCTypesupport('fastrtps'), out),
        (GenerateIntrospectionCTypesupport('introspection'), folder / 'introspection' / NAME),
        (GenerateCTypesupport('c', typesupport_implementations=DISPATCHED), out),
        (GeneratePython('py', typesupport_implementations=['rosidl_typesupport_c']), out),
    ):
        generator.generate(NAME, idl, share, place)
    (out / '__init__.py').touch()


def _compile(folder):
    out = folder / NAME
    roots = [folder, folder / 'introspection', PREFIX / 'include', np.get_include()]
    roots += [place for place in sorted((PREFIX / 'include').iterdir()) if place.is_dir()]
    include = [f'-I{root}' for root in (*roots, sysconfig.get_paths()['include'])]
    objects = []
    for source in sorted([*folder.rglob('*.c'), *folder.rglob('*.cpp')]):
        compiler = ['gcc', '-std=c11'] if source.suffix == '.c' else ['g++', '-std=c++17']
        objects.append(str(source.with_suffix('.o')))
        _run(*compiler, '-w', '-O0', '-fPIC', *include, '-c', source, '-o', objects[-1])
    libraries = [f'-l{name}__{kind}' for name in DEPENDENCIES for kind in KINDS]
    libraries += [f'-l{name}' for name in RUNTIME]
    rest = [f'-L{PREFIX}/lib', *libraries, f'-Wl,-rpath,{PREFIX}/lib']
    _link(out, 'libcontrol_msgs_all.so', *objects, *rest, '-Wl,--unresolved-symbols=ignore-all')
    names = [f'lib{NAME}__{kind}.so' for kind in DISPATCHED]
    for name in names:
        _link(out, name, '-lcontrol_msgs_all')
    (entry,) = [one for one in objects if '_s.ep' in one]
    needed = ['-lcontrol_msgs_all', *(f'-l:{name}' for name in names)]
    _link(out, f'{NAME}_s__rosidl_typesupport_c.so', entry, *needed)


def _link(out, name, *what):
    itself = ['-Wl,--no-as-needed', '-Wl,-rpath,$ORIGIN', f'-L{out}', f'-Wl,-soname,{name}']
    _run('g++', '-shared', '-o', out / name, *itself, *what)


def _run(*command):
    subprocess.run([str(part) for part in command], check=True)
