"""Meshes of a URDF: each moves with its link; what cannot be had is named."""

import json
import sys
import types

import mujoco
import numpy as np
import pytest
import yaml

from hexarm import machines
from hexarm.cli.main import main
from hexarm.link_meshes import link_meshes, read_stl, write_stl
from manipulator.errors import ConfigError
from manipulator.rotation import from_rpy

TETRAHEDRON = np.array([[0, 0, 0], [30, 0, 0], [0, 20, 0], [0, 0, 10.0]])
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
AXES = [(0, 0, 1), (0, 1, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0)]
PLACES = [(0.05, 0, 0.1)] * 4 + [(0.05, 0, 0)] * 2
"""Of each joint on the link before; the last three axes meet, so the arm has a closed form."""
XYZ, RPY, SCALE = (0.01, -0.02, 0.03), (0.3, -0.2, 0.5), (0.001, 0.002, -0.003)


def ascii_stl():
    facets = ''.join(
        'facet normal 0 0 0\nouter loop\n'
        + ''.join(f'vertex {x} {y} {z}\n' for x, y, z in TETRAHEDRON[face])
        + 'endloop\nendfacet\n'
        for face in FACES
    )
    return f'solid t\n{facets}endsolid t\n'


def obj():
    vertices = ''.join(f'v {x} {y} {z}\n' for x, y, z in TETRAHEDRON)
    return (
        'mtllib absent.mtl\n'
        + vertices
        + ''.join(f'f {a + 1} {b + 1} {c + 1}\n' for a, b, c in FACES)
    )


def dae():
    """In centimetres."""
    numbers = ' '.join(map(str, TETRAHEDRON.ravel()))
    return (
        '<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" '
        'version="1.4.1"><asset><unit meter="0.01"/><up_axis>Y_UP</up_axis></asset>'
        '<library_geometries><geometry id="g"><mesh>'
        f'<source id="p"><float_array id="a" count="12">{numbers}</float_array><technique_common>'
        '<accessor source="#a" count="4" stride="3"><param name="X" type="float"/>'
        '<param name="Y" type="float"/><param name="Z" type="float"/></accessor>'
        '</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/>'
        '</vertices><triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>'
        f'<p>{" ".join(str(i) for face in FACES for i in face)}</p></triangles></mesh></geometry>'
        '</library_geometries><library_visual_scenes><visual_scene id="s"><node>'
        '<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>'
        '<scene><instance_visual_scene url="#s"/></scene></COLLADA>'
    )


def visual(file, scale=SCALE):
    place = f'<origin xyz="{" ".join(map(str, XYZ))}" rpy="{" ".join(map(str, RPY))}"/>'
    size = f' scale="{" ".join(map(str, scale))}"' if scale else ''
    return f'<visual>{place}<geometry><mesh filename="{file}"{size}/></geometry></visual>'


def urdf(visuals):
    """Six joints, a hand on link 6, an arm beside; visuals by link."""
    links = [f'link_{i}' for i in range(7)] + ['hand', 'other']
    joints = [(f'joint_{i}', 'revolute', links[i - 1], links[i]) for i in range(1, 7)]
    joints += [('mount', 'fixed', 'link_6', 'hand'), ('beside', 'prismatic', 'link_0', 'other')]
    made = ''.join(
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{" ".join(map(str, place))}" rpy="0 0 0"/>'
        f'<axis xyz="{" ".join(map(str, axis))}"/>'
        '<limit lower="-2" upper="2" velocity="3" effort="7"/></joint>'
        for (name, kind, parent, child), axis, place in zip(
            joints, [*AXES, AXES[0], AXES[0]], [*PLACES, PLACES[0], PLACES[0]], strict=True
        )
    )
    bodies = ''.join(f'<link name="{link}">{visuals.get(link, "")}</link>' for link in links)
    return f'<robot name="arm">{bodies}{made}</robot>'


def frame(i, angles):
    """T_base_link_i by the definition of URDF."""
    T = np.eye(4)
    for axis, place, q in list(zip(AXES, PLACES, angles, strict=True))[:i]:
        cross = np.cross(np.eye(3), axis)
        step = np.eye(4)
        step[:3, :3] += np.sin(q) * cross + (1 - np.cos(q)) * cross @ cross
        step[:3, 3] = place
        T = T @ step
    return T


@pytest.fixture
def bring(tmp_path, capsys):
    """Imports the arm with these visuals; its answer."""

    def run(visuals, *options, status=0):
        file = tmp_path / 'arm.urdf'
        file.write_text(urdf(visuals))
        output = tmp_path / 'mine.yaml'
        words = ['import', str(file), '--output', str(output), '--tip', 'hand', *options]
        assert main([*words, '--json']) == status
        printed = capsys.readouterr()
        return json.loads(printed.out) if status == 0 else printed.out + printed.err

    return run


def meshes_in(folder):
    file = folder / 'mine.yaml'
    return link_meshes(machines.read(str(file)).geometry, folder)


def check_motion(folder, i, triangles, unit=1.0):
    """Whether the tetrahedron of link i, of that unit, is where the URDF puts it."""
    angles = np.array([0.3, -0.5, 0.7, 1.1, -0.2, 0.4])
    moved = machines.load(str(folder / 'mine.yaml')).kinematics.chain.displacements(angles)[i]
    local = unit * TETRAHEDRON[FACES] * SCALE @ from_rpy(RPY).T + XYZ
    T = frame(i, angles)
    expected = local @ T[:3, :3].T + T[:3, 3]
    here = triangles @ moved[:3, :3].T + moved[:3, 3]
    centres = [np.sort(corners.mean(axis=1), axis=0) for corners in (here, expected)]
    np.testing.assert_allclose(*centres, atol=1e-7)
    volume = np.einsum('ni,ni->', here[:, 0], np.cross(here[:, 1], here[:, 2])) / 6
    assert volume == pytest.approx(unit**3 * 1000 * 6e-9, rel=1e-3)  # outside is outside


def test_a_mesh_of_each_format_moves_with_its_link_as_the_urdf_says(tmp_path, bring):
    folder = tmp_path / 'robots' / 'my_arm' / 'meshes'
    folder.mkdir(parents=True)
    (folder / 'a.stl').write_text(ascii_stl())
    (folder / 'b.OBJ').write_text(obj())
    write_stl(folder / 'd.stl', TETRAHEDRON[FACES])
    visuals = {
        'link_0': visual('robots/my_arm/meshes/a.stl'),
        'link_2': visual('package://my_arm/meshes/b.OBJ'),
        'link_5': visual(f'file://{folder}/d.stl'),
        'other': visual('robots/my_arm/meshes/a.stl'),
    }
    answer = bring(visuals, '--package', f'my_arm={tmp_path}/robots/my_arm')
    assert answer['not_imported'] == []
    found, faults = meshes_in(tmp_path)
    assert not faults
    assert [mesh is not None for mesh in found] == [True, False, True, False, False, True, False]
    for i in (0, 2, 5):
        check_motion(tmp_path, i, found[i].triangles)


def test_collada_is_in_metres_with_its_own_unit(tmp_path, bring):
    pytest.importorskip('collada')
    (tmp_path / 'c.dae').write_text(dae())
    assert bring({'link_3': visual('c.dae')})['not_imported'] == []
    check_motion(tmp_path, 3, meshes_in(tmp_path)[0][3].triangles, unit=0.01)


def test_what_hangs_on_the_last_link_is_part_of_its_mesh(tmp_path, bring):
    (tmp_path / 'a.stl').write_text(ascii_stl())
    bring({'link_6': visual('a.stl') + visual('a.stl', None), 'hand': visual('a.stl')})
    assert len(meshes_in(tmp_path)[0][6].triangles) == 12


@pytest.mark.parametrize('variable', ['ROS_PACKAGE_PATH', 'AMENT_PREFIX_PATH', 'beside'])
def test_packages_are_found_where_ros_has_them_and_around_the_urdf(
    tmp_path, bring, monkeypatch, variable
):
    for name in ('ROS_PACKAGE_PATH', 'AMENT_PREFIX_PATH'):
        monkeypatch.delenv(name, raising=False)
    root = tmp_path if variable == 'beside' else tmp_path / 'elsewhere'
    if variable != 'beside':
        monkeypatch.setenv(variable, f'/nowhere:{root}')
    folder = root / 'share' / 'its' if variable == 'AMENT_PREFIX_PATH' else root / 'its'
    folder.mkdir(parents=True)
    (folder / 'a.stl').write_text(ascii_stl())
    assert bring({'link_1': visual('package://its/a.stl')})['not_imported'] == []
    assert meshes_in(tmp_path)[0][1] is not None


@pytest.mark.parametrize(
    ('name', 'content', 'reason'),
    [
        ('gone.stl', None, 'gone.stl: does not exist'),
        ('folder.stl', 'folder', 'folder.stl: is a folder or a device'),
        ('noise.stl', bytes(range(256)) * 9, 'noise.stl: '),
        ('noise.obj', bytes(range(256)) * 9, 'noise.obj: '),
        ('noise.dae', '<COLLADA', 'dae'),
        ('empty.obj', 'v 0 0 0\n', 'empty.obj: has 0 faces'),
        ('endless.obj', 'v inf 0 0\nv 0 nan 0\nv 0 0 1\nf 1 2 3\n', 'corners that are not finite'),
        ('shape.step', 'ISO-10303', 'shape.step: is none of stl, obj'),
        ('https://example.org/a.stl', None, 'is no file of this computer'),
        ('package://unknown/a.stl', None, "package 'unknown', which is not found: --package"),
        ('bad\x7f*.stl', None, 'does not exist'),
        (f'{"long" * 999}.stl', None, 'cannot be read: File name too long'),
        (f'package://{"long" * 999}/a.stl', None, 'is not found: --package'),
        ('one.obj', 'v 1 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n', 'is no surface but'),
        (
            'line.obj',
            'v 1 0 0\nv 0 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3\nf 2 3 4\n',
            'is no surface but',
        ),
        ('far.obj', 'v 1e9 0 0\nv 0 0 0\nv 0 1e9 0\nf 1 2 3\n', 'is it in another unit?'),
    ],
)
def test_a_mesh_that_cannot_be_had_is_named_and_the_arm_is_imported(
    tmp_path, bring, name, content, reason
):
    if content == 'folder':
        (tmp_path / name).mkdir()
    elif content is not None:
        file = tmp_path / name
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
    (tmp_path / 'good.stl').write_text(ascii_stl())
    answer = bring({'link_1': visual(name), 'link_2': visual('good.stl')})
    (fault,) = answer['not_imported']
    assert reason in fault
    assert '\n' not in fault
    assert f'  # {fault[:60]}' in (tmp_path / 'mine.yaml').read_text()
    assert answer['meshes'] == ['', '', 'mine_meshes/link_2.stl', '', '', '', '']


def test_too_many_faces_and_bytes_are_refused(tmp_path, bring, monkeypatch):
    monkeypatch.setattr('hexarm.link_meshes.MOST_FACES', 5)
    monkeypatch.setattr('hexarm.mesh_import.MOST_FACES', 5)
    write_stl(tmp_path / 'many.stl', TETRAHEDRON[FACES * 2])
    (tmp_path / 'a.stl').write_text(ascii_stl())
    twice = visual('a.stl') * 2
    faults = bring({'link_1': visual('many.stl'), 'link_2': twice})['not_imported']
    assert 'many.stl: has 8 faces, 1 to 5' in faults[0]
    assert 'meshes of link_2, together: has 8 faces, 1 to 5' in faults[1]
    (tmp_path / 'mine.yaml').unlink()
    monkeypatch.setattr('hexarm.mesh_import.MOST_BYTES', 300)
    assert 'is larger than' in bring({'link_1': visual('many.stl')})['not_imported'][0]


def test_without_the_libraries_one_line_says_what_to_install(tmp_path, bring, monkeypatch):
    (tmp_path / 'a.stl').write_text(ascii_stl())
    monkeypatch.setitem(sys.modules, 'trimesh', None)
    faults = bring({f'link_{i}': visual('a.stl') for i in range(7)})['not_imported']
    assert faults == ["not imported: meshes need trimesh: pip install 'hexarm[meshes]'"]
    (tmp_path / 'mine.yaml').unlink()
    (tmp_path / 'a.dae').write_text(dae())
    without = types.SimpleNamespace(
        exchange=types.SimpleNamespace(load=types.SimpleNamespace(mesh_formats=lambda: {'stl'}))
    )
    monkeypatch.setitem(sys.modules, 'trimesh', without)
    assert 'pycollada' in bring({'link_1': visual('a.dae')})['not_imported'][0]


def test_nothing_is_written_over(tmp_path, bring):
    (tmp_path / 'a.stl').write_text(ascii_stl())
    (tmp_path / 'mine_meshes').mkdir()
    assert 'mine_meshes exists' in bring({'link_1': visual('a.stl')}, status=2)
    assert not (tmp_path / 'mine.yaml').exists()
    assert '--package' in bring({}, '--package', 'nonsense', status=2)


def test_a_machine_file_whose_mesh_is_lost_is_valid_and_check_names_it(tmp_path, bring, capsys):
    (tmp_path / 'a.stl').write_text(ascii_stl())
    bring({'link_1': visual('a.stl'), 'link_2': visual('a.stl')})
    (tmp_path / 'mine_meshes' / 'link_1.stl').unlink()
    (tmp_path / 'mine_meshes' / 'link_2.stl').write_text(ascii_stl())
    assert main(['check', str(tmp_path / 'mine.yaml')]) == 0
    printed = capsys.readouterr().out
    assert 'link_1.stl: does not exist: its link is drawn as a rod' in printed
    assert 'link_2.stl: is no binary STL: its link is drawn as a rod' in printed


def test_a_machine_file_names_seven_meshes(tmp_path, bring):
    (tmp_path / 'a.stl').write_text(ascii_stl())
    bring({'link_1': visual('a.stl')})
    file = tmp_path / 'mine.yaml'
    content = yaml.safe_load(file.read_text())
    content['geometry']['meshes'] = ['a.stl']
    file.write_text(yaml.safe_dump(content))
    with pytest.raises(ConfigError, match=r'geometry.meshes: has 1 entry, needs 7'):
        machines.load(str(file))


def test_stl_comes_back_and_a_cut_file_is_refused(tmp_path):
    file = tmp_path / 'a.stl'
    write_stl(file, TETRAHEDRON[FACES])
    np.testing.assert_array_equal(read_stl(file), TETRAHEDRON[FACES])
    file.write_bytes(file.read_bytes()[:-1])
    with pytest.raises(ConfigError, match='is no binary STL'):
        read_stl(file)


def test_mujoco_has_the_meshes_in_the_places_of_their_links(tmp_path, bring, capsys):
    (tmp_path / 'a.stl').write_text(ascii_stl())
    (tmp_path / 'flat.obj').write_text('v 1 0 0\nv 0 20 0\nv 0 1 9\nv 0 0 9\nf 1 2 3\nf 2 3 4\n')
    weight = '<inertial><mass value="2"/><inertia ixx=".1" iyy=".1" izz=".1"/></inertial>'
    visuals = {f'link_{i}': weight + visual('a.stl') for i in range(7)}
    visuals |= {'link_2': weight + visual('flat.obj'), 'link_4': weight}
    bring(visuals)
    (tmp_path / 'mine_meshes' / 'link_5.stl').unlink()
    output = tmp_path / 'mine.xml'
    assert main(['mjcf', str(tmp_path / 'mine.yaml'), '--output', str(output)]) == 0
    assert 'link_5.stl: does not exist' in capsys.readouterr().out
    model = mujoco.MjModel.from_xml_path(str(output))
    state = mujoco.MjData(model)
    state.qpos = angles = np.array([0.3, -0.5, 0.7, 1.1, -0.2, 0.4])
    mujoco.mj_forward(model, state)
    of_body = {model.geom_bodyid[i]: model.geom_type[i] for i in range(model.ngeom)}
    kinds = [of_body[model.body(f'link_{i}').id if i else 0] for i in range(7)]
    mesh, rod = int(mujoco.mjtGeom.mjGEOM_MESH), int(mujoco.mjtGeom.mjGEOM_CAPSULE)
    assert kinds == [mesh, mesh, mesh, mesh, rod, rod, mesh]
    geom = next(i for i in range(model.ngeom) if model.geom(i).bodyid == model.body('link_6').id)
    begin, count = model.mesh_vertadr[model.geom_dataid[geom]], 4
    corners = model.mesh_vert[begin : begin + count].astype(float)
    here = corners @ state.geom_xmat[geom].reshape(3, 3).T + state.geom_xpos[geom]
    T = frame(6, angles)
    local = TETRAHEDRON * SCALE @ from_rpy(RPY).T + XYZ
    expected = local @ T[:3, :3].T + T[:3, 3]
    np.testing.assert_allclose(np.sort(here, axis=0), np.sort(expected, axis=0), atol=1e-6)
    assert model.body('link_6').mass == pytest.approx(2.0)
    assert not model.geom_contype.any()
