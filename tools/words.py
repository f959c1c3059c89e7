# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Words that we do not use: the table of that name in docs/glossary.md, and where they stand.

Looked at are documents without their code, and string literals of C++, that is messages and
--help. A phrase of the table may be broken over lines and literals. N in it is a number.
"""
import re

GLOSSARY = 'docs/glossary.md'
HEADING = '## Words that we do not use'
# A record of what was said, and documents that are not ours to reword.
EXEMPT = ('CHANGELOG.md', 'STYLE.md', GLOSSARY)
SOURCES = re.compile(r'(apps|libs|extras)/.*\.[ch]pp$')
TESTS = re.compile(r'/test/')
CODE = re.compile(r'```.*?```|^    .*?$|`[^`\n]*`|\]\([^)]*\)', re.S | re.M)
TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\((?P<raw>.*?)\)\1"|"(?P<text>(?:[^"\\\n]|\\.)*)"|'
                   r"'(?:[^'\\\n]|\\.)+'|\s+|[^\s\"'/R]+|.", re.S)
NOTHING = '\0'  # Stands for what is no text, so that no phrase goes across it.


def blanked(text, sign):
    return re.sub(r'[^\n]', sign, text)


def prose(document):
    """The document with its code blanked, so that offsets stay."""
    return CODE.sub(lambda found: blanked(found[0], NOTHING), document)


def literals(source):
    """The source with all but the contents of string literals blanked."""
    parts = []
    for token in TOKEN.finditer(source):
        whole = token[0]
        content = token['text'] if token['text'] is not None else token['raw']
        if content is not None:
            before = whole.index(content, whole.index('"') + 1)
            parts.append(' ' * before + content + ' ' * (len(whole) - before - len(content)))
        elif whole.isspace():
            parts.append(whole)
        else:
            parts.append(blanked(whole, ' ' if whole.startswith(('//', '/*')) else NOTHING))
    return ''.join(parts).replace('\\n', '  ')


def pattern(phrases):
    """An expression for the phrases of a cell, which a slash parts."""
    found = []
    for phrase in phrases.split(' / '):
        words = [r'[\d.,{}:]+' if word == 'N' else re.escape(word) for word in phrase.split()]
        found.append(r'\s+'.join(words))
    return re.compile(r'(?<![\w-])(?:' + '|'.join(found) + r')(?![\w-])', re.I)


def read_table(root):
    """(Expression of what is not said, what to say instead, expression of exceptions or None)."""
    text = (root / GLOSSARY).read_text()
    section = text[text.index(HEADING):].split('\n## ')[0]
    rows = re.findall(r'^\| (.+?) \| (.+?) \|(.*?)\|$', section, re.M)
    return [(pattern(avoided), instead, pattern(kept.strip()) if kept.strip() else None)
            for avoided, instead, kept in rows[1:]]


def breaches(table, name, text):
    """(Line, what stands there, what to say instead) for each word of the table."""
    if name.endswith('.md') and name not in EXEMPT:
        text = prose(text)
    elif SOURCES.match(name) and not TESTS.search(name):
        text = literals(text)
    else:
        return
    for avoided, instead, kept in table:
        spans = [found.span() for found in kept.finditer(text)] if kept else []
        for found in avoided.finditer(text):
            if not any(start <= found.start() and found.end() <= end for start, end in spans):
                yield (text.count('\n', 0, found.start()) + 1, ' '.join(found[0].split()), instead)
