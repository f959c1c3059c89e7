# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Twenty robots for the site: each with its picture, its verdict and its file."""
import subprocess

# A file of the repository, or a family of `holdfast generate` with its size.
ROBOTS = [
    'scenarios/arm_breaks_b.json', 'scenarios/crane_breaks_a.json', 'scenarios/bush_tips_c.json',
    'scenarios/angle_breaks_b.json', 'scenarios/scary_tips_a.json', 'examples/catoms_hang.json',
    'scenarios/general/battery_on_wall.json', 'scenarios/general/over_a_step.json',
    'scenarios/general/prism_wall.json', 'scenarios/general/shelf_with_payload.json',
    'scenarios/general/tower_on_slope.json', 'scenarios/plan/walk_over_beam.json',
    'arch 9', 'crane 10', 'stairs 5', 'bridge 9', 'portal 8', 'scaffold 5', 'shell 5', 'ball 5',
]

HEAD = '''# Gallery

Twenty robots, drawn by `holdfast check FILE --svg FILE.svg`. `holdfast view FILE` opens one in the
page, where it can be turned and changed.
'''


def run(program, *arguments):
    """What a command prints; an unsafe robot is no failure."""
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode > 2:
        raise SystemExit(f'gallery_page.py: {" ".join(map(str, arguments))}: {done.stderr}')
    return done.stdout


def lay_gallery(repository, program, folder):
    """Writes gallery.md into the folder, and the files that it shows into gallery/ beside it."""
    (folder / 'gallery').mkdir()
    parts = [HEAD]
    for robot in ROBOTS:
        is_family = ' ' in robot
        name = robot.replace(' ', '_') if is_family else robot.rpartition('/')[2][:-len('.json')]
        file = folder / 'gallery' / f'{name}.json'
        file.write_text(run(program, 'generate', *robot.split()) if is_family else
                        (repository / robot).read_text())
        verdict, reason = run(program, 'check', file, '--svg',
                              file.with_suffix('.svg')).splitlines()[:2]
        parts.append(f'## {name.replace("_", " ")}\n\n**{verdict.split()[0]}**: {reason.strip()}.\n'
                     f'{{download}}`{name}.json <gallery/{name}.json>`\n\n'
                     f'![{name.replace("_", " ")}](gallery/{name}.svg)\n')
    (folder / 'gallery.md').write_text('\n'.join(parts))
