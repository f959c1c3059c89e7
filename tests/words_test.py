#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""words_test.py REPOSITORY   tools/words.py finds the words of a table where users read, and there
only. Expected lines are counted by hand."""
import pathlib
import sys
import unittest

REPOSITORY = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(REPOSITORY / 'tools'))
import words  # noqa: E402

TABLE = [(words.pattern('worth'), 'gain', None),
         (words.pattern('loses N of / so long'), 'less', words.pattern('so long as'))]


def found(name, text):
    return [(line, what) for line, what, _ in words.breaches(TABLE, name, text)]


class Words(unittest.TestCase):
    def test_documents_are_read_without_their_code(self):
        text = ('It is\nworth it, `worth`.\n\n    worth\n```\nworth\n```\n'
                '[worth](worth.md) trustworthy\n')
        self.assertEqual(found('docs/a.md', text), [(2, 'worth'), (8, 'worth')])
        self.assertEqual(found('CHANGELOG.md', text), [])

    def test_phrases_are_broken_over_lines(self):
        self.assertEqual(found('docs/a.md', 'It loses\n1.5 of it, so\nlong.\n'),
                         [(1, 'loses 1.5 of'), (2, 'so long')])

    def test_exceptions_are_left(self):
        self.assertEqual(found('docs/a.md', 'so long as it lasts\n'), [])

    def test_sources_are_read_in_their_literals_alone(self):
        text = ('// worth\nint worth = \'"\';\nsay("it loses "\n    "{} of it");\n'
                'say("so", "long");\nsay(R"(no worth)", "a \\"worth\\"");\n')
        self.assertEqual(sorted(found('libs/io/src/a.cpp', text)),
                         [(3, 'loses {} of'), (6, 'worth'), (6, 'worth')])
        self.assertEqual(found('libs/io/test/a.cpp', text), [])

    def test_the_glossary_has_the_table(self):
        self.assertTrue(any(avoided.fullmatch('expected  is') for avoided, _, _ in
                            words.read_table(REPOSITORY)))


unittest.main()
