# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures show what the report says, in the words and colours of the program's SVG.

Expected values come from the SVG, which another program text draws, and from the report's arrays.
"""
import html
import json
import pathlib
import re
import struct
import subprocess
import sys
import xml.etree.ElementTree as ET

import holdfast
import numpy as np
import pytest
from holdfast import Robot, Verdict

matplotlib = pytest.importorskip('matplotlib')
matplotlib.use('Agg')

from holdfast import _bodies, _look, _page  # noqa: E402
from holdfast._painter import Balls, Bodies, Callout, Faces, projected  # noqa: E402
from matplotlib import pyplot  # noqa: E402

ROOT = pathlib.Path(__file__).parents[2]
SCENARIOS = sorted(ROOT.glob('scenarios/*.json'))
COLUMN = [[0, 0, z] for z in range(5)]


def general_robots():
    """Every lattice, supports of every kind, loads, and a gravity that is not straight down."""
    yield Robot([[x, 0, 0] for x in range(4)] + [[0, 0, 1]], planned=[[3, 0, 1]],
                lattice='hexagonal-prism', fixed=[[0, 0, 0]], name='prisms')
    yield Robot([[x, 0, 0] for x in range(4)] + [[x, 0, 1] for x in range(3)],
                planned=[[3, 0, 1]], lattice='hexagonal', name='discs')
    yield Robot([[0, 0, 3], [1, 0, 3], [2, 0, 3], [2, 0, 2]], planned=[[3, 0, 3]], supports=None,
                obstacles=[{'from': (-1, -3, 0), 'to': (-1, 3, 6), 'hold': 'bonded'}],
                loads={(2, 0, 2): (0.5, 0, -1, 20, 0, 0)}, gravity=(1, 0, -9.7), name='shelf')
    yield Robot([[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1]], planned=[[3, 0, 1]],
                obstacles=np.array([[2, 0, 0]]), name='upon a stone')
    yield Robot([[0, 0, 0], [0, 0, 1], [0, 1, 1]], lattice='face-centred', fixed=[[0, 0, 0]],
                planned=[[0, 1, 2]], name='catoms')
    yield holdfast.load(ROOT / 'examples/catoms_hang.json')
    yield Robot(COLUMN, fixed=[[0, 0, 0]], supports=None, gravity=(9.81, 0, 0), name='sideways')


ROBOTS = [holdfast.load(path) for path in SCENARIOS] + list(general_robots())


@pytest.fixture(params=ROBOTS, ids=[robot.name for robot in ROBOTS], scope='module',
                name='report')
def checked(request):
    return request.param.check()


@pytest.fixture(scope='module', name='axes')
def drawn_axes(report):
    axes = report.plot()
    axes.figure.canvas.draw()
    yield axes
    pyplot.close(axes.figure)


def svg_legend(report):
    group = ET.fromstring(report.svg()).find(".//{*}g[@class='legend']")
    return [text.text for text in group.findall('{*}text')]


def legend_of(axes):
    words = [bar.get_title() for bar in axes.child_axes]
    return words + [text.get_text() for text in axes.get_legend().get_texts()]


def bodies_of(axes):
    return next(one for one in axes.collections if isinstance(one, Bodies))


def texts_of(axes):
    return [text.get_text() for text in axes.texts]


def test_the_legend_has_the_words_of_the_svg(report, axes):
    assert legend_of(axes) == svg_legend(report)


def test_the_headline_is_that_of_the_svg(report, axes):
    line = ET.fromstring(report.svg()).find(".//{*}text[@class='verdict']")
    words = ' '.join(' '.join(line.itertext()).split())
    assert words in ' '.join(' '.join(texts_of(axes)).split())


def test_the_svg_has_no_colour_of_a_module_that_the_plot_has_not(report, axes):
    """The plot also has those of faces that others hide."""
    drawn = np.vstack([faces.colors[:, :3] for paint in bodies_of(axes).paints
                       for faces in paint.seen_by(axes)])
    group = ET.fromstring(report.svg()).find(".//{*}g[@class='modules']")
    fills = {one.get('fill') for one in group.iter() if one.get('class') != 'obstacle'}
    fills = {fill for fill in fills if re.fullmatch('#[0-9a-f]{6}', fill or '')}
    assert fills
    missing = [fill for fill in fills if not any(drawn_as(fill, drawn))]
    # The SVG's rims of discs have one colour each, the plot's are many strips.
    assert not missing or report.robot.lattice == 'hexagonal'
    assert len(missing) <= len(fills) / 2


def drawn_as(fill, colors):
    """Which colours are a fill of the SVG, but for the rounding of one mixture after another."""
    channels = [int(fill[i:i + 2], 16) for i in (1, 3, 5)]
    return np.abs(255 * colors - channels).max(axis=1) <= 2


def test_every_module_is_drawn_once_and_planned_ones_dashed(report, axes):
    robot = report.robot
    solid, dashed = set(), set()
    for paint in bodies_of(axes).paints:
        if isinstance(paint, Balls) or paint.edge in (_look.INK, 'face'):
            (dashed if paint.is_dashed else solid).update(map(tuple, np.round(paint.nodes, 6)))
    is_planned = robot.modules['is_planned']
    nodes = [tuple(row) for row in np.round(robot.positions, 6)]
    assert dashed == {node for node, planned in zip(nodes, is_planned) if planned}
    # None is hidden by all its neighbours in these robots.
    assert solid == {node for node, planned in zip(nodes, is_planned) if not planned}


def test_nothing_lies_outside_the_frame_and_axes_are_equal(report, axes):
    spans = [np.ptp(getattr(axes, f'get_{axis}lim')()) for axis in 'xyz']
    assert spans == pytest.approx([spans[0]] * 3)
    flat = axes.transData.transform(projected(axes, report.robot.positions)[:, :2])
    width, height = axes.figure.canvas.get_width_height()
    assert (flat > 0).all() and (flat < [width, height]).all()
    box = axes.get_legend().get_window_extent()
    assert box.x0 > 0 and box.y0 > 0 and box.x1 < width


def test_nothing_of_header_and_legend_overlaps_the_drawing(report, axes):
    robot = report.robot
    corners = robot.positions[:, None] + robot.material['pitch_mm'] / 2 * np.array(
        [[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    flat = axes.transData.transform(projected(axes, corners.reshape(-1, 3))[:, :2])
    header = min(text.get_window_extent().y0 for text in axes.texts[-2:])
    assert flat[:, 1].max() < header
    assert flat[:, 1].min() > axes.get_legend().get_window_extent().y1


def test_the_worst_connection_is_marked_and_named(report, axes):
    callouts = [text for text in axes.texts if isinstance(text, Callout)]
    if report.verdict is Verdict.UNSTABLE or (report.load_ratio_max or 0) < _look.NO_LOAD:
        assert not any('\u00d7' in one.get_text() for one in callouts)
        return
    ends = report.robot.connections[report.worst]
    middle = report.robot.positions[[ends['a'], ends['b']]].mean(axis=0)
    assert callouts[0].point == pytest.approx(middle)
    assert callouts[0].get_text().rstrip(' \u00d7') == f'{report.load_ratio_max:.2f}'
    cells = [','.join(map(str, report.robot.modules['cell'][ends[end]])) for end in 'ab']
    assert f'({cells[0]})-({cells[1]})' in ' '.join(texts_of(axes))


def test_nodes_are_where_the_robot_has_them(report):
    robot = report.robot
    nodes = _bodies.nodes_of(robot, robot.modules['cell']) * robot.material['pitch_mm']
    assert nodes == pytest.approx(robot.positions, abs=1e-9)


def test_cells_fill_space():
    """Volumes of cells, in pitches: 1, a rhombic dodecahedron's 1/sqrt(2), a prism's sqrt(3)/2."""
    for lattice, volume in (('cubic', 1), ('face-centred', 0.5 ** 0.5), ('hexagonal', 0.75 ** 0.5),
                            ('hexagonal-prism', 0.75 ** 0.5)):
        faces = _bodies.cell_faces(Robot([[0, 0, 0]], lattice=lattice).directions)
        total = 0.0
        for face in faces:
            first = face.corners[0]
            area = sum(np.cross(b - first, c - first) @ face.normal / 2
                       for b, c in zip(face.corners[1:], face.corners[2:]))
            total += area * 0.5 / 3  # Every face is half a pitch from the node.
        assert total == pytest.approx(volume)


def test_farther_bodies_are_drawn_first():
    """A front module hides the one behind it: along the line of sight it is drawn later."""
    axes = Robot([[0, 1, 0], [1, 1, 0], [1, 0, 0], [1, 0, 1], [1, 1, 1]]).check().plot()
    bodies = bodies_of(axes)
    axes.figure.canvas.draw()
    front = projected(axes, np.array([[60.0, -20.0, 60.0]]))[0, :2]  # Its corner at the eye.
    touching = [i for i, path in enumerate(bodies.get_paths())
                if np.abs(path.vertices - front).max(axis=1).min() < 1e-9]
    assert touching[-1] == len(bodies.get_paths()) - 1


def test_a_picture_can_be_drawn_into_axes_of_ones_own():
    figure = pyplot.figure()
    axes = figure.add_subplot(1, 2, 1, projection='3d')
    report = holdfast.load(SCENARIOS[0]).check()
    assert report.plot(axes, title='mine', legend=False) is axes
    assert axes.get_legend() is None and 'mine' in texts_of(axes)
    figure.canvas.draw()


def test_an_obstacle_too_large_is_not_drawn():
    report = Robot([[0, 0, 0]], obstacles=[{'from': (-200, -200, -1), 'to': (200, 200, -1)}],
                   supports=None).check()
    assert legend_of(report.plot()) == svg_legend(report)


def test_the_grid_of_vtk_has_the_arrays_of_the_report(report):
    """The file keeps 32 bits of every number, more than nine digits."""
    pytest.importorskip('vtkmodules')
    from vtkmodules.util.numpy_support import vtk_to_numpy
    grid = report.to_vtk()
    robot = report.robot
    counts = len(robot), len(robot.connections), len(robot.facets)

    def array(name):
        return vtk_to_numpy(grid.GetCellData().GetArray(name))
    kinds = array('kind').tolist()  # Obstacles, 3, come last, if there are any.
    assert kinds == [k for k in range(3) for _ in range(counts[k])] + [3] * (
        grid.GetNumberOfCells() - sum(counts))
    assert (3 in kinds) == bool(robot.obstacles)
    assert (array('cell')[:counts[0]] == robot.modules['cell']).all()
    assert (array('planned')[:counts[0]] == robot.modules['is_planned']).all()
    connections = slice(counts[0], counts[0] + counts[1])
    for name in ('load_ratio', 'axial_n', 'bending_nmm', 'shear_n', 'torsion_nmm'):
        expected = report.connections[name] if _look.has_loads(report) else 0
        assert array(name)[connections] == pytest.approx(expected, rel=1e-9, abs=1e-300)
    if len(report.facet_forces):
        assert array('ground_force_n')[sum(counts[:2]):sum(counts)] == pytest.approx(
            report.facet_forces['force_n'], rel=1e-9, abs=1e-300)


def page_of(folder, text):
    path = folder / 'page' / 'holdfast.html'
    path.parent.mkdir()
    path.write_text(text, encoding='utf-8')


EMPTY_PAGE = ('<!doctype html><title>holdfast</title><script type="application/json" '
              'id="holdfast-start">null</script><noscript>'
              '<!-- holdfast view puts the report here. --></noscript>')


def test_the_page_holds_structure_and_report(tmp_path, monkeypatch):
    monkeypatch.setattr('holdfast._page.__file__', str(tmp_path / 'python/holdfast/_page.py'))
    page_of(tmp_path, EMPTY_PAGE)
    robot = Robot([[0, 0, 0], [0, 0, 1]], name='</script><b>&')
    report = robot.check(limit=True)
    page = report.page()
    assert page.count('</script>') == 1  # The name ends nothing.
    start = json.loads(re.search('holdfast-start">(.*?)</script>', page)[1])
    assert Robot.from_text(start['structure']).cells.tolist() == robot.cells.tolist()
    assert start['name'] == robot.name and start['report'].endswith(report.text())
    assert start['limit'].keys() >= {'factor', 'yields', 'velocities'}
    assert '<title>&lt;/script&gt;&lt;b&gt;&amp; - holdfast</title>' in page
    frame = _page.frame(report)
    inside = html.unescape(re.fullmatch('<iframe srcdoc="([^"]*)".*</iframe>', frame, re.S)[1])
    start = json.loads(re.search('holdfast-start">(.*?)</script>', inside)[1])
    assert 'report' not in start and start['name'] == robot.name


def test_a_notebook_shows_the_picture_of_a_report():
    report = holdfast.load(ROOT / 'scenarios/arm_breaks_b.json').check()
    assert not hasattr(report, '_repr_html_')
    assert report._repr_svg_() == report.svg() and len(report.svg()) < 300_000


def test_without_the_page_show_shows_the_picture(tmp_path, monkeypatch):
    monkeypatch.setattr('holdfast._page.__file__', str(tmp_path / 'python/holdfast/_page.py'))
    monkeypatch.setattr(sys, 'prefix', str(tmp_path))
    report = Robot([[0, 0, 0]]).check()
    shown = _page.frame(report)
    assert report.svg() in shown and './dev page' in html.unescape(shown)
    with pytest.raises(holdfast.PageNotFound, match="'./dev page' builds it"):
        report.page()
    page_of(tmp_path, 'another page')
    with pytest.raises(holdfast.PageNotFound, match="no page of holdfast's"):
        report.page()


def test_show_opens_the_page_in_a_browser(tmp_path, monkeypatch):
    monkeypatch.setattr('holdfast._page.__file__', str(tmp_path / 'python/holdfast/_page.py'))
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    opened = []
    monkeypatch.setattr('webbrowser.open', opened.append)
    page_of(tmp_path, EMPTY_PAGE)
    report = Robot([[0, 0, 0]]).check()
    report.show()
    (made,) = tmp_path.glob('holdfast-*.html')
    assert opened == [made.as_uri()] and made.read_text() == report.page()


def test_show_shows_the_page_below_a_cell():
    """In a kernel, by what it sends to the notebook."""
    pytest.importorskip('ipykernel')
    nbclient = pytest.importorskip('nbclient')
    import nbformat
    source = 'import holdfast; holdfast.Robot([[0, 0, 0]]).check().show(height=321)'
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source)])
    nbclient.NotebookClient(notebook, timeout=120, kernel_name='python3').execute()
    (output,) = notebook.cells[0].outputs
    assert 'height="321"' in output.data['text/html'] or './dev page' in html.unescape(
        output.data['text/html'])


def test_what_is_optional_is_not_imported_before_it_is_used():
    code = ('import sys, holdfast; holdfast.Robot([[0, 0, 0]]).check().svg(); '
            'print([name for name in ("matplotlib", "vtkmodules", "PIL", "IPython") '
            'if name in sys.modules])')
    done = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True)
    assert done.stdout == '[]\n'


def test_places_and_steps_show_themselves_as_pictures():
    places = Robot([[0, 0, 0]]).next()
    assert ET.fromstring(places._repr_svg_()).tag.endswith('svg')
    assert ET.fromstring(steps_of()._repr_svg_()).tag.endswith('svg')


def test_what_is_not_installed_is_named(monkeypatch):
    report = Robot([[0, 0, 0]]).check()
    monkeypatch.setitem(sys.modules, 'vtkmodules', None)
    with pytest.raises(ImportError, match='apt install python3-vtk9'):
        report.to_vtk()
    monkeypatch.setitem(sys.modules, 'matplotlib', None)
    with pytest.raises(ImportError, match='apt install python3-matplotlib'):
        report.plot()


def steps_of(walk='scenarios/plan/walk_over_beam.json'):
    return holdfast.steps(ROOT / walk)


def test_curves_of_steps_are_the_judgement():
    robot = holdfast.load(ROOT / 'scenarios/arm_breaks_a.json')
    tip = [{'attach': [[x, 1, 2]]} for x in range(6, 10)]
    for judged in (holdfast.steps(robot, tip), steps_of()):
        figure = holdfast.plot_steps(judged)
        bands, ratio, margin = figure.axes
        assert len(bands.patches) == 3 * len(judged)
        assert [tick.get_text() for tick in bands.get_yticklabels()] == [
            stage.value for stage in holdfast.Stage]
        colors = [matplotlib.colors.to_hex(patch.get_facecolor()) for patch in bands.patches]
        expected = [_look.BAND_INKS[list(Verdict)[one]] for one in judged.stages['verdict'].T.flat]
        assert colors == expected
        assert ratio.patches[0].get_data().values.max() == judged.load_ratio_max
        assert margin.patches[0].get_data().values.min() == judged.margin_min_mm
        words = figure._suptitle.get_text()
        assert ('first unsafe' in words) == (judged.first_unsafe is not None)
        # The same inks as in the program's picture.
        for color in set(colors):
            assert color in judged.svg()
        pyplot.close(figure)


@pytest.mark.parametrize('is_reversed', [False, True])
def test_curves_of_an_order_are_its_way(is_reversed):
    target = holdfast.load(ROOT / 'scenarios/plan/counterweight.json')
    found = holdfast.order(target, reverse=is_reversed)
    size, ratio, margin = holdfast.plot_order(found).axes
    sizes = [1, len(target)]
    assert size.lines[0].get_ydata()[[0, -1]].tolist() == sizes[::-1 if is_reversed else 1]
    known = {line.get_label(): line.get_ydata() for line in ratio.lines}
    assert np.nanmax(known['solved']) == pytest.approx(found.load_ratio_max, rel=1e-12)
    assert margin.lines[0].get_ydata().min() == pytest.approx(found.margin_min_mm, rel=1e-12)
    pyplot.close('all')


def test_states_are_those_that_the_steps_lead_to():
    """The walker's module ends where the last move puts it, and the last state is what is judged
    in the last stage."""
    from holdfast._pictures import states
    judged = steps_of()
    walk = list(states(judged.robot))
    assert len(walk) == len(judged) + 1
    for state, stages in zip(walk[1:], judged.stages):
        ratio, margin = stages[2]['load_ratio_max'], stages[2]['margin_mm']
        report = state.check()
        assert report.load_ratio_max == pytest.approx(ratio, abs=1e-9)
        assert report.stability['margin_mm'] == pytest.approx(margin)


def test_states_of_planned_and_later_steps_and_of_kinds():
    from holdfast._pictures import states
    robot = Robot([[0, 0, 0]], planned=[[0, 0, 1]], kinds={'heavy': {'mass_kg': 1.0}},
                  kind_of={(0, 0, 0): 'heavy', (0, 0, 1): 'heavy'})
    before, after = states(robot)
    assert before.masses.tolist() == [1] and after.masses.tolist() == [1, 1]


def test_a_film_has_a_frame_for_every_state(tmp_path):
    image = pytest.importorskip('PIL.Image')
    judged = steps_of()
    film = holdfast.animate(judged, tmp_path / 'walk.gif')
    assert len(film) == len(judged) + 1
    with image.open(tmp_path / 'walk.gif') as gif:
        assert gif.n_frames == len(film)
    with pytest.raises(holdfast.Error, match=r'\.gif or \.html'):
        film.save(str(tmp_path / 'walk.avi'))
    with pytest.raises(holdfast.Error, match='at least one report'):
        holdfast.animate([])
    pyplot.close('all')


def test_a_film_as_html_needs_no_network(tmp_path):
    reports = [Robot(COLUMN[:count]).check() for count in (1, 2, 3)]
    film = holdfast.animate(reports, tmp_path / 'column.html')
    text = (tmp_path / 'column.html').read_text()
    assert len(re.findall(r'frames\[\d+\] = "data:image/png', text)) == len(film) == 3
    pyplot.close('all')


def test_nothing_jumps_in_a_film():
    """The ground module is seen at one place in all frames."""
    film = holdfast.animate([Robot(COLUMN[:count]).check() for count in (1, 5)])
    places = []
    for index in range(len(film)):
        figure = film.frame(index)
        axes = next(one for one in figure.axes if hasattr(one, 'get_proj'))
        figure.canvas.draw()
        places.append(axes.transData.transform(projected(axes, np.zeros((1, 3)))[:, :2]))
    assert places[0] == pytest.approx(places[1])
    pyplot.close('all')


def test_a_picture_is_written_as_its_name_says(tmp_path):
    report = holdfast.Robot([[0, 0, 0], [0, 0, 1]]).check()
    for name, begin in (('a.svg', b'<svg'), ('a.png', b'\x89PNG'), ('a.pdf', b'%PDF')):
        report.save_figure(tmp_path / name, size=(640, 480), view=(-60, 30), legend=False)
        assert (tmp_path / name).read_bytes().startswith(begin)
    width, height = struct.unpack('>II', (tmp_path / 'a.png').read_bytes()[16:24])
    assert (width, height) == (640, 480)


def test_a_picture_does_what_it_is_asked():
    report = holdfast.Robot([[0, 0, 0], [0, 0, 1]]).check()
    assert 'width="500"' in report.svg(size=500)
    assert 'Top view' in report.svg(view='top')
    assert '>foot</text>' in report.svg(title='foot')
    assert 'class="legend"' in report.svg() and 'class="legend"' not in report.svg(legend=False)
    assert report.svg(grey=True) != report.svg()
    for options, said in (({'size': 3}, '16 to 20000 pixels'), ({'view': 'below'}, 'expected iso'),
                          ({'view': (0, 99)}, '0 to 90')):
        with pytest.raises(holdfast.Error, match=said):
            report.svg(**options)


def test_steps_are_drawn_one_by_one_and_side_by_side():
    robot = holdfast.Robot([[0, 0, 0]])
    judged = holdfast.steps(robot, [{'attach': [[x, 0, 0]]} for x in range(1, 4)])
    strip = judged.strip().svg()
    assert strip.count('class="frame"') == 4
    assert [strip.count(f'>after step {step}<') for step in range(4)] == [1, 1, 1, 0]
    assert 'after step 1' in judged.state(1).svg()
    assert 'start' in judged.state(None).svg()
    with pytest.raises(holdfast.Error, match='expected a step from 0 to 2, or start; found 3'):
        judged.state(3).svg()


def test_a_strip_has_all_states_that_there_is_room_for():
    robot = holdfast.Robot([[0, 0, 0]])
    for count in (1, 21, 22, 23, 24, 25, 100):
        judged = holdfast.steps(robot, [{'attach': [[x, 0, 0]]} for x in range(1, count + 1)])
        strip = judged.strip().svg()
        frames = strip.count('class="frame"')
        assert frames == count + 1 if count < 24 else 22 < frames <= 24
        assert '>start<' in strip and f'>after step {count - 1}<' in strip


def test_a_strip_of_many_steps_has_the_first_unsafe_one():
    robot = holdfast.Robot([[0, 0, 0]], fixed=[[0, 0, 0]], supports=None)
    judged = holdfast.steps(robot, [{'attach': [[x, 0, 0]]} for x in range(1, 41)])
    unsafe = judged.first_unsafe[0]
    strip = judged.strip().svg()
    assert strip.count('class="frame"') <= 24
    for step in (unsafe, 39):
        assert f'>after step {step}<' in strip
    assert strip.count('>OVERLOAD<') >= 1
