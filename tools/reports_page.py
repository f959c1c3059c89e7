# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""The site's page of reports: the keys of docs/schemas as tables. site.py lays it out."""
import json

HEAD = '''# Reports

What `--json` writes, key by key, made from the schemas. All begin with the keys of
[head](#common-head); [formats](formats.md#reports-json) says what they have in common. Units are N,
mm, N mm, kg and s unless a name or a meaning says otherwise.
'''


def forms(schema):
    """The schema and what it may be instead, or consists of."""
    items = schema.get('items')
    return [schema, *schema.get('oneOf', []), *([items] if isinstance(items, dict) else [])]


def link(reference, file):
    """To the heading of a definition; `file` is the name of the schema that refers to it."""
    path, _, place = reference.partition('#')
    name = place.split('/')[-1]
    file = path.split('/')[-1].removesuffix('.schema.json') or file
    return f'See [{name}](#{file}-{name}).' if name else f'As in {file}.schema.json.'


def meaning(schema, file):
    parts = [form['description'] for form in forms(schema) if 'description' in form]
    if 'const' in schema:
        parts.append(f'Always `{json.dumps(schema["const"])}`.')
    if 'enum' in schema:
        words = (f'`{json.dumps(word)}`' for word in schema['enum'])
        parts.append(f'One of {", ".join(words)}.')
    parts += [link(form['$ref'], file) for form in forms(schema) if '$ref' in form]
    return ' '.join(parts)


def rows(schema, path, file, found):
    """Key with its path -> what it means, of an object and of those in it."""
    for form in forms(schema):
        for key, value in form.get('properties', {}).items():
            if key != 'report' or 'const' not in value:
                found.setdefault(path + key, meaning(value, file))
                rows(value, f'{path}{key}.', file, found)
        if form is not schema:
            rows(form, path, file, found)
    return found


def table(schema, file):
    found = rows(schema, '', file, {})
    lines = ['', '| key | meaning |', '|---|---|'] if found else []
    return '\n'.join([meaning(schema, file), *lines,
                      *(f'| `{key}` | {words} |' for key, words in found.items()), ''])


def reports_page(folder):
    parts = [HEAD]
    for path in sorted(folder.glob('*.schema.json')):
        schema, file = json.loads(path.read_text()), path.name.removesuffix('.schema.json')
        # As code, or two dashes would become a long one.
        parts += [f'## `{schema["title"]}`\n', table(schema, file)]
        for name, part in schema.get('$defs', {}).items():
            parts += [f'### {file}: {name}\n', table(part, file)]
    return '\n'.join(parts)
