# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Every public name is described; examples in descriptions run; types are those that are said."""
import ast
import doctest
import importlib
import inspect
import pkgutil
import subprocess
import sys

import holdfast
import pytest

MODULES = ['holdfast', *(f'holdfast.{module.name}' for module in pkgutil.iter_modules(
    holdfast.__path__) if module.name != '_core')]


@pytest.mark.parametrize('name', MODULES)
def test_examples_in_descriptions_run(name):
    module = importlib.import_module(name)
    failed, _ = doctest.testmod(module, optionflags=doctest.ELLIPSIS |
                                doctest.IGNORE_EXCEPTION_DETAIL,
                                extraglobs={key: getattr(holdfast, key)
                                            for key in holdfast.__all__})
    assert failed == 0


def public_members():
    for name in holdfast.__all__:
        thing = getattr(holdfast, name)
        yield name, thing
        if inspect.isclass(thing) and thing.__module__.startswith('holdfast'):
            for member, value in vars(thing).items():
                if not member.startswith('_') and (
                        callable(value) or isinstance(value, (property, classmethod))):
                    yield f'{name}.{member}', value


@pytest.mark.parametrize('document', ['README.md', 'docs/python.md'])
def test_documents_are_true(root, monkeypatch, document):
    monkeypatch.chdir(root)
    failed, count = doctest.testfile(str(root / document), module_relative=False,
                                     optionflags=doctest.IGNORE_EXCEPTION_DETAIL)
    assert failed == 0 and count > 3


@pytest.mark.parametrize('name, thing', public_members(), ids=lambda value: str(value)[:40])
def test_everything_is_described(name, thing):
    text = inspect.getdoc(thing)
    assert text and text[0].isupper() and len(text.split()) >= 1, name


def test_errors_are_those_of_values():
    assert issubclass(holdfast.Error, ValueError)
    assert repr(holdfast.Error('so')) == "Error('so')" and holdfast.Error.__module__ == 'holdfast'


def test_all_names_are_exported():
    public = {name for name in vars(holdfast) if not name.startswith('_')}
    assert public == set(holdfast.__all__)


def imported(path):
    """The package's own modules that a file imports, within functions as well, but for types."""
    tree = ast.parse(path.read_text())
    of_types = {id(node) for branch in ast.walk(tree) if isinstance(branch, ast.If)
                and ast.unparse(branch.test) == 'TYPE_CHECKING' for node in ast.walk(branch)}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level == 1 and id(node) not in of_types:
            yield from [node.module] if node.module else [name.name for name in node.names]


def test_no_two_files_import_each_other(root):
    """Not by way of others either: a file whose imports are all known is known, until all are."""
    left = {path.stem: set(imported(path)) - {'_core'}
            for path in (root / 'python/holdfast').glob('*.py')}
    assert len(left) > 20 and '_report' in left['_robot']
    while known := {name for name, wanted in left.items() if not wanted & left.keys()}:
        left = {name: wanted for name, wanted in left.items() if name not in known}
    assert left == {}


# Debian 12's mypy has keyword arguments that a TypedDict lists only where that is asked for.
MYPY = ('mypy', '--strict', '--no-error-summary', '--enable-incomplete-feature=Unpack')


def run_mypy(*arguments, folder=None):
    done = subprocess.run([sys.executable, '-m', *arguments], capture_output=True, text=True,
                          cwd=folder)
    assert done.returncode == 0, done.stdout + done.stderr


def test_types_are_strict(root):
    """The package, and programs that use it."""
    run_mypy(*MYPY, '--cache-dir', str(root / 'build/mypy'),
             '-p', 'holdfast')
    examples = sorted((root / 'examples/python').glob('*.py'))
    if examples:
        run_mypy(*MYPY, '--ignore-missing-imports',
                 '--cache-dir', str(root / 'build/mypy'), *map(str, examples))


def test_stubs_are_those_of_the_extension(tmp_path):
    """But for how pybind11 makes classes."""
    (tmp_path / 'allowed').write_text(r'holdfast\._core\.[A-Z]\w+(\.__init__)?')
    run_mypy('mypy.stubtest', '--ignore-missing-stub', '--allowlist', str(tmp_path / 'allowed'),
             '--ignore-unused-allowlist', 'holdfast._core', folder=tmp_path)
