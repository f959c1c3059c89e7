# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Robots from arrays of every kind; what is no robot is refused in one line."""
import copy
import importlib.metadata
import io
import json
import os
import pathlib
import pickle
import struct

import holdfast
import numpy as np
import pytest
from holdfast import Robot

TOWER = np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2]])


def test_the_least_that_works():
    r = Robot([[0, 0, 0], [0, 0, 1], [1, 0, 1]], planned=[[2, 0, 1]]).check()
    assert r.verdict.name in ('SAFE', 'OVERLOAD', 'UNSTABLE', 'UNDECIDED')
    # Eq. (17): two modules hang beside the post; 1.5 weights at 40 mm bend the first connection,
    # whose lever is 20 mm and whose strength is 14.97 N.
    weight = 0.06106 * 9.81
    moment = weight * 20 + weight * 60
    assert r.connections['load_ratio'].max() == pytest.approx(moment / 20 / 14.97, rel=1e-3)


@pytest.mark.parametrize('dtype', ['i1', 'u1', 'i2', 'u2', 'i4', 'u4', 'i8', 'u8', '>i4', '>i8'])
def test_any_integers(dtype):
    assert Robot(TOWER.astype(dtype)).cells.tolist() == TOWER.tolist()


def test_any_strides():
    wide = np.zeros((6, 6), dtype=int)
    wide[::2, ::2] = TOWER
    for array in (wide[::2, ::2], np.asfortranarray(TOWER), TOWER[::-1][::-1],
                  TOWER.T.copy().T, np.broadcast_to(TOWER, (3, 3))):
        assert Robot(array).cells.tolist() == TOWER.tolist()
    assert Robot(TOWER[::-1]).cells.tolist() == TOWER[::-1].tolist()


def test_lists_tuples_and_what_is_like_an_array():
    class Like:
        def __array__(self, dtype=None):
            return TOWER

    for cells in (TOWER.tolist(), [tuple(cell) for cell in TOWER.tolist()], Like()):
        assert len(Robot(cells)) == 3


def test_sets_in_ascending_order_and_generators():
    cells = [(0, 0, 0), (0, 0, 1), (0, 0, 2)]
    more = {(0, 1, 0), (-1, 0, 0)}
    robot = Robot(cells, planned=sorted(more), fixed=cells[:1])
    assert robot.planned.tolist()[0] == [-1, 0, 0]
    for many in (set(cells), frozenset(cells), dict.fromkeys(cells).keys()):
        assert Robot(many, planned=more, fixed={cells[0]}) == robot
    assert Robot((c for c in cells), planned=iter(sorted(more)), fixed=iter(cells[:1])) == robot


NOT_CELLS = [
    None, 3, 'text', {}, object(), [[0, 0]], [[0, 0, 0, 0]], [0, 0, 0], [[[0, 0, 0]]],
    [[0.5, 0, 0]], [[float('nan')] * 3], [[float('inf'), 0, 0]], [['a', 'b', 'c']], [[0, 0, None]],
    [[0, 0, 0], [0, 0]], np.zeros((3, 0), dtype=int), np.zeros((0, 4, 2)),
    np.zeros((1, 3), dtype=bool), np.zeros((1, 3), dtype=complex),
    np.zeros((1, 3), dtype='M8[s]'), np.zeros(1, dtype=[('x', 'i4')]), [[2**70, 0, 0]],
    [[2**63, 0, 0]], [[2**62, 0, 0]], [[-2**63, 0, 0]], [[10**6 + 1, 0, 0]],
    np.array([[2**64 - 1, 0, 0]], dtype='u8'), np.array([[2**32, 0, 0]], dtype='u8')]


@pytest.mark.parametrize('cells', NOT_CELLS, ids=lambda cells: str(cells)[:30])
@pytest.mark.parametrize('where', ['cells', 'planned', 'fixed'])
def test_what_is_no_array_of_cells(cells, where):
    if where != 'cells' and cells is None:
        return  # There are none.
    options = {'cells': [[0, 0, 0]], where: cells}
    with pytest.raises(holdfast.Error) as caught:
        Robot(**options)
    assert isinstance(caught.value, ValueError)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize('cells, said', [
    ([], 'no existing module'),
    (np.zeros((0, 3)), 'no existing module'),
    ([[0, 0, 0], [0, 0, 0]], 'the cell (0,0,0) is listed twice'),
    ([[0, 0, 5]], 'nothing holds the robot'),
    ([[0, 0, 0], [5, 0, 0]], 'not connected')])
def test_what_is_no_robot(cells, said):
    with pytest.raises(holdfast.Error, match=said.replace('(', r'\(').replace(')', r'\)')):
        Robot(cells)


@pytest.mark.parametrize('options', [
    {'lattice': 'diamond'}, {'robot': 'robby'}, {'material': {'mass': 1}},
    {'material': {'mass_kg': float('nan')}}, {'material': {'mass_kg': -1}},
    {'material': {'mass_kg': 'heavy'}}, {'masses': [1.0]}, {'masses': [[1.0, 2.0, 3.0]]},
    {'masses': [float('nan')] * 3}, {'masses': [-1.0, 1, 1]}, {'masses': {(9, 9, 9): 1.0}},
    {'loads': {(9, 9, 9): (0, 0, 1)}}, {'loads': {(0, 0, 0): (0, 1)}},
    {'loads': {(0, 0, 0): (0, 0, float('inf'))}}, {'gravity': (0, 0)},
    {'gravity': (0, 0, float('nan'))}, {'supports': 2**80}, {'supports': 0.5},
    {'supports': {'bonds': 1}}, {'fixed': [True]}, {'fixed': [[9, 9, 9]]},
    {'obstacles': [{'cells': [[0, 0, 0]]}]}, {'obstacles': [{'hold': 'tight'}]},
    {'kind_of': {(0, 0, 0): 'unknown'}}, {'steps': [{'jump': 1}]}, {'kinds': {'a': object()}},
    {'open': [[(0, 0, 0), (0, 0, 2)]]}, {'open': [[(0, 0, 0)]]}, {'open': 3},
    {'open': [[(0, 0, 0), (0, 0, 1)]]}, {'joined': 'some'},
    {'bodies': [[(0, 0, 0), (0, 0, 2)]]}, {'bodies': [[(0, 0, 0), (5, 0, 0)]]}, {'bodies': 3},
    {'bodies': [[]]}, {'bodies': [[(0, 0, 0), (0, 0, 1)], [(0, 0, 1)]]}, {'bodies': [(0, 0, 0)]},
    {'connections': [{'strength_n': 3}]},
    {'connections': [{'between': [(0, 0, 0), (0, 0, 1)], 'strength_n': -1}]}])
def test_options_that_are_refused(options):
    with pytest.raises((holdfast.Error, TypeError)) as caught:
        Robot(TOWER, **options)
    assert len(str(caught.value).splitlines()) == 1


def test_masses_loads_and_kinds_are_where_they_belong():
    robot = Robot(TOWER, planned=[[1, 0, 2]], masses={(0, 0, 1): 0.5, (1, 0, 2): 0.25},
                  kinds={'battery': {'mass_kg': 0.2}}, kind_of={(0, 0, 2): 'battery'},
                  loads={(0, 0, 2): (0, 0, -2)})
    assert robot.masses.tolist() == [0.06106, 0.5, 0.2, 0.25]
    # The ground carries all of it.
    force = robot.check().ground_forces['force_n'].sum(axis=0)
    assert force[2] == pytest.approx((0.06106 + 0.5 + 0.2 + 0.25) * 9.81 + 2, rel=1e-9)
    by_number = Robot(TOWER, masses=[0.1, 0.2, 0.3])
    assert by_number.masses.tolist() == [0.1, 0.2, 0.3]


HOOK = [[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2], [1, 0, 1]]


@pytest.mark.parametrize('said', [
    {'open': [[(0, 0, 1), (1, 0, 1)]]}, {'open': np.array([[[1, 0, 1], [0, 0, 1]]])},
    {'open': {((0, 0, 1), (1, 0, 1))}}, {'open': iter([[[0, 0, 1], (1, 0, 1)]])},
    {'joined': 'listed', 'connections': [{'between': pair} for pair in zip(HOOK, HOOK[1:])]}])
def test_faces_that_touch_need_not_be_joined(said):
    robot = Robot(HOOK, **said)
    assert len(robot.connections) == 4
    # By statics: two modules hang a pitch beside the column.
    bent = robot.check().connections['bending_nmm'].max()
    assert bent == pytest.approx(2 * 0.06106 * 9.81 * 40, rel=1e-9)
    assert robot.translated((3, 0, 0)).check().load_ratio_max == robot.check().load_ratio_max
    assert Robot.from_text(robot.json()).connections.tolist() == robot.connections.tolist()


def test_a_connection_has_its_own_strength():
    pair = [(0, 0, 2), (1, 0, 2)]
    whole = Robot(HOOK, open=[[(0, 0, 1), (1, 0, 1)]])
    weak = Robot(HOOK, open=[[(0, 0, 1), (1, 0, 1)]],
                 connections=[{'between': pair, 'strength_n': 6}])
    ratio = weak.check().load_ratio_max / whole.check().load_ratio_max
    assert ratio == pytest.approx(14.97 / 6, rel=1e-3)


ROW = [[x, 0, 0] for x in range(6)]


@pytest.mark.parametrize('bodies', [
    [ROW[:2], ROW[2:4], ROW[4:]], np.array(ROW).reshape(3, 2, 3),
    ({tuple(cell) for cell in ROW[i:i + 2]} for i in (0, 2, 4)),
    [[{'from': [2 * i, 0, 0], 'to': [2 * i + 1, 0, 0]}] for i in range(3)]])
def test_bodies_part_only_from_each_other(bodies):
    robot = Robot(ROW, fixed=ROW[:1], supports=None, bodies=bodies)
    # By statics: behind the first stud four modules hang, at two pitches in the mean.
    assert robot.check().load_ratio_max == pytest.approx(16 * 0.06106 * 9.81 / 14.97, rel=1e-9)
    assert Robot(ROW, fixed=ROW[:1], supports=None).check().verdict == holdfast.Verdict.OVERLOAD
    for same in (Robot.from_text(robot.json()), pickle.loads(pickle.dumps(robot)),
                 robot.rotated(1), robot.translated((2, 3, 4))):
        assert same.check().load_ratio_max == pytest.approx(robot.check().load_ratio_max)
    assert Robot.from_text(robot.json()) == robot
    assert len(json.loads(robot.json())['bodies']) == 3


def test_planned_bodies_go_with_their_modules():
    robot = Robot(ROW[:4], planned=ROW[4:], bodies=[ROW[:2], ROW[4:]])
    assert len(json.loads(robot.planning(np.empty((0, 3), int)).json())['bodies']) == 1
    assert len(json.loads(robot.attached().json())['bodies']) == 2
    grown = Robot(ROW[:2], bodies=[ROW[:2], ROW[2:4]], steps=[{'attach': ROW[2:4]}])
    assert len(json.loads(grown.with_steps([{'attach': [[0, 0, 1]]}]).json())['bodies']) == 1
    with pytest.raises(holdfast.Error, match='a body comes and goes as a whole'):
        grown.with_steps([{'attach': ROW[2:3]}, {'attach': ROW[3:4]}])
    with pytest.raises(holdfast.Error, match='none at'):
        robot.planning(ROW[4:5])


def test_a_mask_and_cells_fix_the_same():
    by_mask = Robot(TOWER, fixed=[True, False, False])
    by_cells = Robot(TOWER, fixed=[[0, 0, 0]])
    assert by_mask == by_cells
    assert by_mask.modules['support'].tolist() == [2, 0, 0]


def test_voxels():
    voxels = np.zeros((2, 1, 3), dtype=int)
    voxels[0, 0, :] = 1
    voxels[0, 0, 0] = 3
    voxels[1, 0, 2] = 2
    robot = Robot.from_voxels(voxels, origin=(-4, 5, 0))
    assert robot.cells.tolist() == [[-4, 5, 0], [-4, 5, 1], [-4, 5, 2]]
    assert robot.planned.tolist() == [[-3, 5, 2]]
    assert robot.modules['support'].tolist() == [2, 0, 0, 0]
    for wrong in (np.zeros((2, 2)), np.zeros((1, 1, 1)), np.full((1, 1, 1), 4),
                  np.zeros((0, 0, 0))):
        with pytest.raises(holdfast.Error):
            Robot.from_voxels(wrong)


def test_lattices_and_a_wall():
    """A catom on a bonded floor of catoms holds; VisibleSim's names of modules do as well."""
    robot = Robot([[0, 0, 0], [0, 0, 1]], lattice='catoms3D', supports=None,
                  obstacles=[{'from': (-1, -1, -1), 'to': (1, 1, -1), 'hold': 'bonded'}])
    assert robot.lattice == 'face-centred'
    assert robot.supports is None
    assert robot.check().verdict is holdfast.Verdict.SAFE
    # All neighbours are one pitch apart.
    ends = robot.positions[robot.connections['a']] - robot.positions[robot.connections['b']]
    assert np.linalg.norm(ends, axis=1) == pytest.approx(robot.material['pitch_mm'])


def test_obstacles_are_cells_or_what_json_has():
    cells = [(1, 0, 0), (1, 0, 1)]
    as_json = Robot(TOWER, obstacles=[{'cells': cells}])
    # The wall beside the tower: two facets touch it, and one the floor.
    assert len(as_json.facets) == 3
    for given in (cells, tuple(cells), [list(cell) for cell in cells], np.array(cells),
                  [np.array(cell) for cell in cells]):
        assert Robot(TOWER, obstacles=given) == as_json
        assert Robot(TOWER, supports={'obstacles': given}) == as_json
    for none in ([], np.zeros((0, 3), dtype=int)):
        assert Robot(TOWER, obstacles=none) == Robot(TOWER)
    for wrong in ([1, 0, 0], [(1, 0)], [(1.5, 0, 0)], [(1, 0, 2**70)], [(0, 0, 0)], 'wall', 3,
                  [(1, 0, 0), {'cells': [(2, 0, 0)]}], [[(1, 0, 0)]]):
        with pytest.raises(holdfast.Error, match='obstacle'):
            Robot(TOWER, obstacles=wrong)


def test_files_are_read_and_written(root, tmp_path):
    for path in sorted((root / 'scenarios').glob('*.json')):
        robot = holdfast.load(path)
        assert robot.name
        robot.save(tmp_path / 'robot.json')
        assert Robot.from_file(tmp_path / 'robot.json').json() == robot.json()
        robot.save(tmp_path / 'robot.xml')
        again = Robot.from_file(tmp_path / 'robot.xml')
        assert (again.modules == robot.modules).all()
        assert again.check().verdict is robot.check().verdict
    for kind in (holdfast.Error, FileNotFoundError):
        with pytest.raises(kind, match='no such file'):
            holdfast.load(tmp_path / 'absent.json')
    with pytest.raises(holdfast.Error, match='absent'):
        robot.save(tmp_path / 'absent' / 'robot.json')
    (tmp_path / 'bad.json').write_text('{"format": "holdfast-structure", "version": 1}')
    with pytest.raises(holdfast.Error, match='bad.json.*modules'):
        holdfast.load(tmp_path / 'bad.json')


@pytest.mark.parametrize('kind', [os.fsencode, os.fsdecode, pathlib.Path])
def test_files_whose_names_are_not_utf_8(tmp_path, kind):
    """A path is what Python's open() takes."""
    def here(ending):
        return kind(os.fsdecode(os.fsencode(tmp_path) + b'/m\xfcnze.' + ending))

    robot = Robot(TOWER)
    for ending in (b'json', b'xml'):
        robot.save(here(ending))
        with open(here(ending), encoding='utf-8') as file:
            assert file.read().startswith('<?xml' if ending == b'xml' else '{')
        again = holdfast.load(here(ending))
        assert (again.cells == robot.cells).all() and again.name == 'm\ufffdnze'
        assert pickle.loads(pickle.dumps(again)) == again
        assert 'm\ufffdnze' in str(again.check())
    report = robot.check()
    for save in (report.save_json, report.save_csv, report.save_svg, report.save_vtu):
        save(here(b'out'))
        assert os.path.getsize(here(b'out')) > 0
    with pytest.raises(holdfast.Error, match=r'm\\xfcnze.absent: no such file'):
        holdfast.load(here(b'absent'))
    with pytest.raises(holdfast.Error, match='pvd'):
        holdfast.steps(robot, [{'attach': [[0, 0, 3]]}]).save_vtk(here(b'pvd'))


def test_paths_that_no_file_can_have(tmp_path):
    robot = Robot(TOWER)
    robot.save(tmp_path / 'a.json')
    for path in (f'{tmp_path}/a.json\0more', os.fsencode(tmp_path) + b'/a.json\0', '\ud800'):
        with pytest.raises(ValueError):
            open(path)
        for use in (holdfast.load, robot.save, robot.check().save_json,
                    holdfast.steps(robot, [{'attach': [[0, 0, 3]]}]).save_vtk):
            with pytest.raises(holdfast.Error, match='path'):
                use(path)
    with pytest.raises(TypeError):
        holdfast.load(3)
    assert os.listdir(tmp_path) == ['a.json']


def test_names_that_no_file_can_keep():
    robot = Robot(TOWER, name='T\u00fcrme \U0001f5fc')
    assert Robot.from_text(robot.json()).name == robot.name == 'T\u00fcrme \U0001f5fc'
    for name in ('a\0b', 'a\x1b', 'a\udcfc'):
        with pytest.raises(holdfast.Error, match='name|surrogates') as caught:
            Robot(TOWER, name=name)
        assert len(str(caught.value).splitlines()) == 1
    for call in (lambda text: Robot.from_text(robot.json(), name=text),
                 lambda text: Robot(TOWER, lattice=text), lambda text: holdfast.generate(text, 3),
                 lambda text: Robot(TOWER, kinds={'a': {}}, kind_of={(0, 0, 0): text}),
                 lambda text: robot.simulate(method=text)):
        with pytest.raises(holdfast.Error, match='surrogates'):
            call('a\udcfc')


def test_copies_and_pickles_are_equal():
    robot = Robot(TOWER, planned=[[1, 0, 2]], masses={(0, 0, 1): 0.5}, name='tower')
    for again in (pickle.loads(pickle.dumps(robot)), copy.copy(robot), copy.deepcopy(robot)):
        assert again == robot and hash(again) == hash(robot)
        assert again.name == 'tower'
    assert robot != Robot(TOWER)
    assert robot != 'tower'


def test_attached_and_planning():
    robot = Robot(TOWER, planned=[[1, 0, 2]], masses={(1, 0, 2): 0.3})
    grown = robot.attached()
    assert grown.cells.tolist() == [*TOWER.tolist(), [1, 0, 2]]
    assert grown.masses[3] == 0.3 and len(grown.planned) == 0
    assert robot.planning([[0, 0, 3]]).planned.tolist() == [[0, 0, 3]]
    assert robot.planned.tolist() == [[1, 0, 2]]


def test_arrays_are_read_only_and_keep_the_robot_alive():
    cells = Robot(TOWER).cells
    with pytest.raises(ValueError):
        cells[0] = 1
    assert cells.tolist() == TOWER.tolist()


def test_the_catalogue():
    blinky = holdfast.robots.get('blinky-blocks')
    assert blinky.figures['mass_kg'].value == Robot(TOWER, robot='blinky-blocks').masses[0]
    with pytest.raises(holdfast.Error, match='there are blinky-blocks'):
        holdfast.robots.get('robby')
    assert set(holdfast.families()) >= {'arm', 'cube', 'tower'}
    assert len(holdfast.generate('cube', 3)) == 27
    with pytest.raises(holdfast.Error, match='no family'):
        holdfast.generate('sphere', 3)


def test_what_is_said_twice_is_refused():
    cells = [[0, 0, 0], [1, 0, 0]]
    with pytest.raises(holdfast.Error, match='supports'):
        Robot(cells, obstacles=[{'cells': [[2, 0, 0]]}], supports={'obstacles': []})
    with pytest.raises(holdfast.Error, match='supports'):
        Robot(cells, supports={'gravity_m_s2': [0, 0, 1]})
    with pytest.raises(holdfast.Error, match='voxels'):
        Robot.from_voxels(np.array([[[3, 1]]]), fixed=None)


def test_another_robot_has_no_known_answer():
    robot = Robot.from_text('{"format": "holdfast-structure", "version": 1, "modules": [[0,0,0]],'
                            ' "planned": [[0,0,1]], "known_answer": {"verdict": "safe"}}')
    assert 'known_answer' in robot.json()
    for other in (robot.attached(), robot.planning([]), robot.with_steps([])):
        assert 'known_answer' not in other.json()


def test_unknown_keys_are_errors_in_texts_files_and_arguments(tmp_path):
    text = ('{"format": "holdfast-structure", "version": 1, "modules": [[0,0,0]], "blocks": 1, '
            '"x-mine": {}}')
    path = tmp_path / 'robot.json'
    path.write_text(text)
    for read in (lambda **options: holdfast.load(path, **options),
                 lambda **options: Robot.from_text(text, **options)):
        with pytest.raises(holdfast.Error, match="/blocks: the key 'blocks' is unknown, expected"):
            read()
        assert ['blocks' in warning for warning in read(allow_unknown=True).warnings] == [True]
    with pytest.raises(holdfast.Error, match="'weight' is unknown, expected"):
        Robot([[0, 0, 0]], material={'weight': 1})
    grams = Robot([[0, 0, 0]], material={'mass_kg': 61.06})
    assert [warning[:16] for warning in grams.warnings] == ['density 954 t/m3']


def test_lists_of_cells_and_meshes_are_robots(tmp_path):
    path = tmp_path / 'cells.csv'
    path.write_text('x,y,z\n0,0,2\n0,0,3\n')
    robot = holdfast.load(path)
    assert robot.cells.tolist() == [[0, 0, 2], [0, 0, 3]]
    assert robot.check().verdict.name == 'SAFE'
    assert any('read as list of cells' in warning for warning in robot.warnings)
    with pytest.raises(holdfast.Error, match='nothing holds the robot'):
        holdfast.load(path, supports=0)
    for given in ('lowest', 2):
        assert len(holdfast.load(path, supports=given)) == 2
    with pytest.raises(holdfast.Error, match='expected lowest or an integer'):
        holdfast.load(path, supports='floor')
    mesh = tmp_path / 'mesh.obj'
    corners = [(x, y, z) for x in (0, 40) for y in (0, 40) for z in (0, 80)]
    mesh.write_text(''.join(f'v {x} {y} {z}\n' for x, y, z in corners) + 'f 1 2 4 3\nf 5 6 8 7\n'
                    'f 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n')
    assert holdfast.load(mesh, pitch=40).cells.tolist() == [[0, 0, 0], [0, 0, 1]]
    with pytest.raises(holdfast.Error, match='a mesh needs the edge of a module'):
        holdfast.load(mesh)
    voxels = tmp_path / 'one.vox'
    xyzi = b'XYZI' + struct.pack('<3I4B', 8, 0, 1, 0, 0, 0, 7)
    main = b'MAIN' + struct.pack('<2I', 0, len(xyzi))
    voxels.write_bytes(b'VOX ' + struct.pack('<I', 150) + main + xyzi)
    palette = {'kinds': {'battery': {'mass_kg': 0.2}}, 'palette': {'7': 'battery'}}
    assert '"kind": "battery"' in holdfast.load(voxels, palette=palette).json()
    with pytest.raises(holdfast.Error, match='no kind for the colour 7'):
        holdfast.load(voxels, palette={**palette, 'palette': {}})


def test_the_lowest_layer_may_stand():
    voxels = np.zeros((3, 3, 5), dtype=bool)
    voxels[1, 1, 2:] = True
    with pytest.raises(holdfast.Error, match='nothing holds the robot'):
        holdfast.Robot.from_voxels(voxels)
    report = holdfast.Robot.from_voxels(voxels, supports='lowest').check()
    assert report.verdict.name == 'SAFE'
    with pytest.raises(holdfast.Error, match='supports: expected'):
        holdfast.Robot([[0, 0, 0]], supports='ground')


def test_foreign_formats_have_all_that_is_said_of_them():
    rows = holdfast.foreign_formats()
    assert {'.csv', '.vox', '.stl', '.obj', '.ldr'} <= {
        ending for row in rows for ending in row['endings'].split()}
    assert all(all(row.values()) for row in rows)


def test_files_that_are_open_are_read(tmp_path):
    text = '{"format": "holdfast-structure", "version": 1, "modules": [[0,0,0], [1,0,0]]}'
    path = tmp_path / 'two.json'
    path.write_text(text)
    for source in (io.StringIO(text), io.BytesIO(text.encode())):
        assert holdfast.load(source) == Robot.from_text(text)
    with open(path, encoding='utf-8') as file:
        robot = holdfast.load(file)
    assert (robot.name, robot) == ('two', holdfast.load(path))
    with pytest.raises(holdfast.Error, match='expected text in UTF-8, found other bytes'):
        holdfast.load(io.BytesIO(b'\xff\xfe\x00'))
    with pytest.raises(holdfast.Error, match="found 'two.json'; holdfast.load reads files"):
        Robot('two.json')


def test_what_readers_note_is_a_warning(tmp_path):
    path = tmp_path / 'grams.json'
    path.write_text('{"format": "holdfast-structure", "version": 1, "modules": [[0,0,0]], '
                    '"material": {"mass_kg": 61.06}}')
    for read in (holdfast.load, Robot.from_file):
        with pytest.warns(holdfast.RobotWarning, match='is the mass in kg') as said:
            robot = read(path)
        assert [str(one.message) for one in said] == robot.warnings
        assert said[0].filename == __file__


def test_pip_knows_the_package():
    assert importlib.metadata.version('holdfast') == holdfast.__version__
