# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""The site's page of reports: the keys of docs/schemas as tables. site.py lays it out."""
import json

HEAD = '''# Reports

What `--json` writes, key by key, made from the schemas. All begin with the keys of
[head](#head); [formats](formats.md#reports-json) says what they have in common. Units are N, mm,
N mm, kg and s unless a name or a meaning says otherwise.
'''


def forms(schema):
    """The schema and what it may be instead, or consists of."""
    items = schema.get('items')
    return [schema, *schema.get('oneOf', []), *([items] if isinstance(items, dict) else [])]


def named(reference):
    return reference.split('/')[-1].removesuffix('.schema.json')


def meaning(schema):
    parts = [form['description'] for form in forms(schema) if 'description' in form]
    if 'const' in schema:
        parts.append(f'Always `{json.dumps(schema["const"])}`.')
    if 'enum' in schema:
        words = (f'`{json.dumps(word)}`' for word in schema['enum'])
        parts.append(f'One of {", ".join(words)}.')
    parts += [f'See [{named(form["$ref"])}](#{named(form["$ref"]).replace("_", "-")}).'
              for form in forms(schema) if '$ref' in form]
    return ' '.join(part for part in parts if part)


def rows(schema, path, found):
    """Key with its path -> what it means, of an object and of those in it."""
    for form in forms(schema):
        for key, value in form.get('properties', {}).items():
            if key != 'report' or 'const' not in value:
                found.setdefault(path + key, meaning(value))
                rows(value, f'{path}{key}.', found)
        if form is not schema:
            rows(form, path, found)
    return found


def table(schema):
    found = rows(schema, '', {})
    lines = ['', '| key | meaning |', '|---|---|'] if found else []
    return '\n'.join([meaning(schema), *lines,
                      *(f'| `{key}` | {words} |' for key, words in found.items()), ''])


def reports_page(folder):
    parts = [HEAD]
    for path in sorted(folder.glob('*.schema.json')):
        schema = json.loads(path.read_text())
        parts += [f'## {schema["title"]}\n', table(schema)]
        for name, part in schema.get('$defs', {}).items():
            parts += [f'### {name}\n', table(part)]
    return '\n'.join(parts)
