#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""serve_test.py HOLDFAST ROOT [--sanitized]   holdfast serve answers as the commands do, whatever
it is sent. A program with sanitizers takes no notice of a limit of its memory."""
import base64
import glob
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest

HOLDFAST, ROOT = sys.argv[1], pathlib.Path(sys.argv[2])
IS_SANITIZED = '--sanitized' in sys.argv
LONG = {'seconds': 300, 'exact': True, 'progress': True}
ARM = [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]]
# Keys that say when, how long and from which file.
RUN = {'seconds', 'robot', 'preparation_seconds', 'factor_seconds', 'name', 'options',
       'wall_seconds', 'processor_seconds', 'setup_seconds', 'solve_seconds'}


class Client:
    """A process and its pipes, in a folder for its temporary files."""

    def __init__(self, *options):
        self.folder = tempfile.TemporaryDirectory()
        self.process = subprocess.Popen([HOLDFAST, 'serve', *options], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                        env={**os.environ, 'TMPDIR': self.folder.name})
        self.count = 0

    def send(self, message):
        text = message if isinstance(message, str) else json.dumps(message)
        self.process.stdin.write(text + '\n')
        self.process.stdin.flush()

    def begin(self, method, **params):
        self.count += 1
        self.send({'jsonrpc': '2.0', 'id': self.count, 'method': method, 'params': params})
        return self.count

    def read(self):
        return json.loads(self.process.stdout.readline())

    def ask(self, method, **params):
        number = self.begin(method, **params)
        answer = self.read()
        assert answer['id'] == number, answer
        return answer

    def end(self):
        """Closes its input; returns exit code, rest of the output and what is left of its files."""
        rest, errors = self.process.communicate(timeout=60)
        left = os.listdir(self.folder.name)
        self.folder.cleanup()
        return self.process.returncode, rest, errors, left

    def end_files(self):
        """Of a process that has ended: nothing of its own is left."""
        for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
            try:
                pipe.close()
            except BrokenPipeError:
                pass
        left = os.listdir(self.folder.name)
        self.folder.cleanup()
        assert not left, left


def answer_of(report):
    """A report without what depends on the run."""
    if isinstance(report, dict):
        return {key: answer_of(value) for key, value in report.items() if key not in RUN}
    return [answer_of(value) for value in report] if isinstance(report, list) else report


def command(*arguments, text=''):
    run = subprocess.run([HOLDFAST, *arguments], input=text, capture_output=True, text=True,
                         check=False)
    return run.returncode, run.stdout


class Served(unittest.TestCase):
    def setUp(self):
        self.client = Client()

    def tearDown(self):
        code, _, errors, left = self.client.end()
        self.assertEqual((code, errors, left), (0, '', []))

    def assert_error(self, answer, code, *words):
        self.assertIn('error', answer)
        self.assertEqual(answer['error']['code'], code, answer)
        for word in words:
            self.assertIn(word, answer['error']['message'])

    def test_reports_are_those_of_the_commands(self):
        count = 0
        for path in sorted(glob.glob(str(ROOT / 'scenarios' / '*.json')))[::4]:
            text = pathlib.Path(path).read_text(encoding='utf-8')
            for name in ('check', 'next'):
                code, report = command(name, '--json', '-', '-', text=text)
                answer = self.client.ask(name, structure=json.loads(text))
                if code >= 64:
                    self.assertIn('error', answer)
                    continue
                self.assertEqual(answer['result']['exit_code'], code)
                self.assertEqual(answer_of(answer['result']['report']),
                                 answer_of(json.loads(report)))
                count += 1
        self.assertGreater(count, 10)

    def test_a_loaded_structure_serves_by_its_name(self):
        loaded = self.client.ask('load', name='arm.json', structure=ARM)['result']
        self.assertEqual((loaded['name'], loaded['modules']), ('arm.json', 4))
        self.assertEqual(self.client.ask('loaded')['result']['structures'], ['arm.json'])
        by_name = self.client.ask('check', structure='arm.json')['result']['report']
        inline = self.client.ask('check', structure=ARM)['result']['report']
        self.assertEqual(answer_of(by_name), answer_of(inline))
        self.assertEqual(by_name['robot']['file'], 'arm.json')
        self.assertIsNone(self.client.ask('unload', name='arm.json')['result'])
        self.assert_error(self.client.ask('check', structure='arm.json'), -32602, "'arm.json'")

    def test_a_name_is_no_path(self):
        for name in ('../x', '/tmp/x', '', '.x', '-x', 'request-1', 'a' * 101, 'a b', 'a\nb'):
            self.assert_error(self.client.ask('load', name=name, structure=ARM), -32001, 'name')

    def test_try_agrees_with_next(self):
        generator = random.Random(5)
        for _ in range(20):
            cells = {(0, 0, 0)}
            while len(cells) < 12:
                x, y, z = generator.choice(sorted(cells))
                step = generator.choice([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)])
                cells.add((x + step[0], y + step[1], z + step[2]))
            structure = {'format': 'holdfast-structure', 'version': 1, 'support_z': 0,
                         'modules': [list(cell) for cell in sorted(cells)]}
            self.client.ask('load', name='robot', structure=structure)
            places = self.client.ask('next', structure='robot')['result']['report']['candidates']
            tried = self.client.ask('try', structure='robot',
                                    cells=[place['cell'] for place in places])['result']
            self.assertEqual(len(places), len(tried['candidates']))
            for place, trial in zip(places, tried['candidates']):
                for key in ('cell', 'verdict'):
                    self.assertEqual(place[key], trial[key])
                ratio = place['load_ratio_max']
                if ratio is not None:
                    self.assertAlmostEqual(ratio, trial['load_ratio_max'], places=8)

    def test_options_are_parameters(self):
        strong = self.client.ask('check', structure=ARM, set={'strength_lateral_n': 1e6},
                                 safety_factor=2, remedies=False)['result']['report']
        self.assertEqual(strong['options'], {'set': ['strength_lateral_n=1000000.0'],
                                             'safety-factor': '2'})
        picture = self.client.ask('check', structure=ARM, svg=True)['result']['outputs']['svg']
        self.assertTrue(picture.startswith('<svg'))
        drawn = self.client.ask('check', structure=ARM, svg='png')
        if 'error' in drawn:
            self.assertIn('librsvg', drawn['error']['message'])
        else:
            png = base64.b64decode(drawn['result']['outputs']['svg']['base64'])
            self.assertTrue(png.startswith(b'\x89PNG'))
        table = self.client.ask('check', structure=ARM, csv=True)['result']['outputs']['csv']
        self.assertEqual(len(table.splitlines()), 1 + 4)  # A head, and the connections of a ring.
        steps = self.client.ask('order', target=ARM, output=True)['result']
        judged = self.client.ask('steps', structure=json.loads(steps['outputs']['output']))
        self.assertEqual(judged['result']['report']['verdict'], 'safe')
        arch = self.client.ask('generate', family='arch', size=9, output='xml')
        self.assertEqual(self.client.ask('check', structure=arch['result']['outputs']['output'])
                         ['result']['exit_code'], 0)

    def test_what_is_wrong_is_said(self):
        together = {'structure': ARM, 'deformed': True, 'remedies': True}
        for params, words in (({}, ["'structure'", 'missing']),
                              ({'structur': ARM}, ['structur', "did you mean 'structure'"]),
                              ({'structure': 3}, ['found a number']),
                              ({'structure': ARM, 'remedies': 'yes'}, ['true or false']),
                              ({'structure': ARM, 'scatter': 'much'}, ['--scatter']),
                              ({'structure': ARM, 'scatter': -3}, ['--scatter']),
                              ({'structure': ARM, 'set': [[1]]}, ['set', 'found an array']),
                              ({'structure': ARM, 'svg': '../x'}, ['svg', 'ending']),
                              ({'structure': ARM, 'json': 'x'}, ['json']),
                              (together, ['--remedies'])):
            self.assert_error(self.client.ask('check', **params), -32602, *words)
        bad = {'format': 'holdfast-structure', 'version': 1, 'modules': [[0, 0, 0], [0, 0]]}
        self.assert_error(self.client.ask('check', structure=bad), -32001, '/modules/1')
        self.assert_error(self.client.ask('check', structure=[[0, 0, 0], [5, 0, 0]]), -32001,
                          'connected')
        self.assert_error(self.client.ask('chekc'), -32601, 'chekc')
        self.assert_error(self.client.ask('try', structure='x', cells=[[0, 0, 0]]), -32001, "'x'")
        self.assert_error(self.client.ask('try', structure='x', cells=[[0, 0, 1e9]]), -32602,
                          'cells')

    def test_messages_are_those_of_json_rpc(self):
        head = '{"jsonrpc": "2.0", "id": 1, '
        for line, code in (('nonsense', -32700), ('{"jsonrpc":', -32700), ('[' * 100000, -32700),
                           ('[]', -32600), ('7', -32600), ('{"id": 1}', -32600),
                           ('{"jsonrpc": "1.0", "id": 1, "method": "loaded"}', -32600),
                           ('{"jsonrpc": "2.0", "id": [1], "method": "loaded"}', -32600),
                           (head + '"method": 7}', -32600),
                           (head + '"method": "loaded", "params": [1]}', -32602)):
            self.client.send(line)
            self.assert_error(self.client.read(), code)
        self.client.send('')
        self.client.send({'jsonrpc': '2.0', 'method': 'loaded'})  # A notification has no answer.
        self.client.send([{'jsonrpc': '2.0', 'method': 'loaded'}])
        self.client.send([{'jsonrpc': '2.0', 'id': 'a', 'method': 'loaded'}, 1,
                          {'jsonrpc': '2.0', 'method': 'loaded'},
                          {'jsonrpc': '2.0', 'id': 'b', 'method': 'check',
                           'params': {'structure': ARM}}])
        answers = {answer['id']: answer for answer in self.client.read()}
        self.assertEqual(sorted(answers, key=str), [None, 'a', 'b'])
        self.assert_error(answers[None], -32600)
        self.assertEqual(answers['b']['result']['exit_code'], 0)

    def test_whatever_comes_the_next_request_is_answered(self):
        generator = random.Random(7)
        good = json.dumps({'jsonrpc': '2.0', 'id': 1, 'method': 'check',
                           'params': {'structure': ARM}})
        for _ in range(300):
            text = list(good)
            for _ in range(generator.randint(1, 4)):
                at = generator.randrange(len(text))
                text[at:at + generator.randint(0, 3)] = generator.choice(
                    ['', '"', '{', ']', '\\', '\x01', '-1e999', 'null', '\u00e9', '[[[['])
            self.client.send(''.join(text).replace('\n', ' '))
        number = 10**6
        self.client.send({'jsonrpc': '2.0', 'id': number, 'method': 'check',
                          'params': {'structure': ARM}})
        answers = []
        while not answers or answers[-1].get('id') != number:
            answers.append(self.client.read())
        self.assertEqual(answers[-1]['result']['exit_code'], 0)
        self.assertGreater(sum('error' in answer for answer in answers), 100)

    def test_many_at_once_are_all_answered(self):
        numbers = {self.client.begin('check', structure=ARM) for _ in range(300)}
        self.assertEqual({self.client.read()['id'] for _ in numbers}, numbers)

    def test_a_client_may_write_all_before_it_reads(self):
        request = json.dumps({'jsonrpc': '2.0', 'id': 1, 'method': 'methods'})
        count = 200  # Some 30 KB of answer each: far more than a pipe holds.
        for _ in range(count):
            self.client.send(request + ' ' * 2000)
        self.assertEqual(sum('result' in self.client.read() for _ in range(count)), count)

    def test_a_request_can_be_cancelled_and_tells_its_progress(self):
        cube = self.client.ask('generate', family='cube', size=14, output=True)
        structure = json.loads(cube['result']['outputs']['output'])
        number = self.client.begin('order', target=structure, **LONG)
        told = self.client.read()
        self.assertEqual((told['method'], told['params']['id']), ('progress', number))
        begin = time.monotonic()
        self.client.send({'jsonrpc': '2.0', 'method': 'cancel', 'params': {'id': number}})
        answer = self.client.read()
        while 'method' in answer:
            answer = self.client.read()
        self.assertEqual(answer['id'], number)
        self.assert_error(answer, -32800)
        self.assertLess(time.monotonic() - begin, 30)

    def test_shutdown_ends_it(self):
        self.assertIsNone(self.client.ask('shutdown')['result'])
        self.assertEqual(self.client.process.wait(timeout=60), 0)


class Ends(unittest.TestCase):
    """What ends a request, a client or the server leaves nothing behind."""

    def long(self, client):
        cube = client.ask('generate', family='cube', size=14, output=True)
        structure = json.loads(cube['result']['outputs']['output'])
        number = client.begin('order', target=structure, **LONG)
        client.read()  # Progress: it runs.
        return number

    def children(self, client):
        listed = subprocess.run(['ps', '-o', 'pid=', '--ppid', str(client.process.pid)],
                                capture_output=True, text=True, check=False).stdout.split()
        return [int(pid) for pid in listed]

    def test_the_limit_of_time(self):
        client = Client('--request-seconds', '2')
        number = self.long(client)
        answer = client.read()
        while 'method' in answer:
            answer = client.read()
        self.assertEqual((answer['id'], answer['error']['code']), (number, -32003))
        self.assertEqual(client.end()[::3], (0, []))

    @unittest.skipIf(IS_SANITIZED, 'sanitizers reserve all memory at the start')
    def test_the_limit_of_memory(self):
        client = Client('--request-memory', '0.1')
        cube = {'format': 'holdfast-structure', 'version': 2, 'support_z': 0,
                'modules': [{'from': [0, 0, 0], 'to': [79, 79, 79]}]}
        answer = client.ask('check', structure=cube)
        self.assertEqual(answer['error']['code'], -32002, str(answer)[:300])
        self.assertEqual(client.ask('loaded')['result']['structures'], [])
        self.assertEqual(client.end()[::3], (0, []))

    def test_a_client_that_dies(self):
        client = Client()
        self.long(client)
        children = self.children(client)
        self.assertEqual(len(children), 1)
        client.process.stdout.close()
        self.assertEqual(client.process.wait(timeout=60), 0)
        client.end_files()
        for child in children:
            with self.assertRaises(ProcessLookupError):
                os.kill(child, 0)

    def test_a_signal(self):
        client = Client()
        self.long(client)
        client.process.send_signal(signal.SIGTERM)
        self.assertEqual(client.process.wait(timeout=60), 0)
        client.end_files()


class Mcp(unittest.TestCase):
    """The Model Context Protocol; tests/mcp has its own client."""

    def test_a_tool_answers_with_text_report_and_picture(self):
        client = Client('--mcp')
        hello = client.ask('initialize', protocolVersion='2025-03-26', capabilities={},
                           clientInfo={'name': 'test', 'version': '1'})['result']
        self.assertEqual(hello['protocolVersion'], '2025-03-26')
        client.send({'jsonrpc': '2.0', 'method': 'notifications/initialized'})
        tools = {tool['name']: tool for tool in client.ask('tools/list')['result']['tools']}
        self.assertIn('picture', tools['check']['inputSchema']['properties'])
        self.assertNotIn('svg', tools['check']['inputSchema']['properties'])
        self.assertEqual(tools['generate']['inputSchema']['required'], ['family', 'size'])
        result = client.ask('tools/call', name='check',
                            arguments={'structure': ARM, 'picture': True})['result']
        self.assertFalse(result['isError'])
        self.assertEqual([part['type'] for part in result['content']], ['text', 'image'])
        picture = result['content'][1]
        begin = b'\x89PNG' if picture['mimeType'] == 'image/png' else b'<svg'
        self.assertTrue(base64.b64decode(picture['data']).startswith(begin))
        self.assertEqual(result['structuredContent']['verdict'], 'safe')
        made = client.ask('tools/call', name='generate', arguments={'family': 'crane', 'size': 6})
        crane = made['result']['content'][1]['text']
        judged = client.ask('tools/call', name='check', arguments={'structure': crane})['result']
        self.assertEqual(judged['structuredContent']['verdict'],
                         json.loads(command('check', '--json', '-', '-', text=crane)[1])['verdict'])
        wrong = client.ask('tools/call', name='check', arguments={'structure': 'x'})['result']
        self.assertTrue(wrong['isError'])
        self.assertEqual(client.ask('tools/call', name='rm', arguments={})['error']['code'], -32602)
        self.assertEqual(client.end()[::3], (0, []))


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
