# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""How pip builds the package (PEP 517): by CMake, with what Debian's packages provide, so that no
network is needed. Needs the packages of `./dev python`, and nothing of Python's own."""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def version():
    text = (ROOT / 'CMakeLists.txt').read_text()
    return re.search(r'project\(holdfast VERSION ([\d.]+)', text)[1]


def tag():
    python = f'cp{sys.version_info.major}{sys.version_info.minor}'
    return f'{python}-{python}-{re.sub("[-.]", "_", sysconfig.get_platform())}'


def lay_package(folder, build):
    """Builds the extension in `build` and installs the package into `folder`."""
    def cmake(*arguments):
        subprocess.run(['cmake', *arguments], check=True, stdout=sys.stderr)

    options = {'CMAKE_BUILD_TYPE': 'Release', 'HOLDFAST_BUILD_PYTHON': 'ON',
               'HOLDFAST_BUILD_TESTS': 'OFF', 'Python_EXECUTABLE': sys.executable}
    if not (build / 'CMakeCache.txt').exists():
        options['HOLDFAST_INSTALL'] = 'OFF'
    generator = [] if (build / 'CMakeCache.txt').exists() else ['-G', 'Ninja']
    cmake('-S', os.fspath(ROOT), '-B', os.fspath(build), *generator,
          *(f'-D{key}={value}' for key, value in options.items()))
    cmake('--build', os.fspath(build), '--target', 'holdfast_python')
    cmake('--install', os.fspath(build), '--component', 'python', '--strip', '--prefix', folder)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """`pip install --config-settings build-dir=FOLDER .` builds there instead of build/pip."""
    build = ROOT / (config_settings or {}).get('build-dir', 'build/pip')
    info = f'holdfast-{version()}.dist-info'
    name = f'holdfast-{version()}-{tag()}.whl'
    files = {f'{info}/WHEEL': 'Wheel-Version: 1.0\nGenerator: holdfast\nRoot-Is-Purelib: false\n'
                              f'Tag: {tag()}\n'.encode()}
    with tempfile.TemporaryDirectory() as folder:
        lay_package(folder, build)
        packages = pathlib.Path(folder) / 'lib/python3/dist-packages'
        for path in sorted(packages.rglob('*')):
            if path.is_file():
                files[path.relative_to(packages).as_posix()] = path.read_bytes()
    record = ''
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, 'w', zipfile.ZIP_DEFLATED) as wheel:
        for file, data in files.items():
            wheel.writestr(file, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()
            record += f'{file},sha256={digest},{len(data)}\n'
        wheel.writestr(f'{info}/RECORD', f'{record}{info}/RECORD,,\n')
    return name


def build_sdist(sdist_directory, config_settings=None):
    """What git tracks."""
    folder = f'holdfast-{version()}'
    names = subprocess.run(['git', 'ls-files'], cwd=ROOT, check=True, capture_output=True,
                           text=True).stdout.splitlines()
    with tarfile.open(pathlib.Path(sdist_directory) / f'{folder}.tar.gz', 'w:gz') as archive:
        for name in names:
            archive.add(ROOT / name, f'{folder}/{name}')
    return f'{folder}.tar.gz'
