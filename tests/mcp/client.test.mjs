// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// `holdfast serve --mcp` as the official SDK's client meets it. HOLDFAST names the program.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {Client} from '@modelcontextprotocol/sdk/client/index.js';
import {StdioClientTransport} from '@modelcontextprotocol/sdk/client/stdio.js';

const kArm = [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]];

async function withClient(use) {
  const client = new Client({name: 'test', version: '1'});
  await client.connect(new StdioClientTransport(
      {command: process.env.HOLDFAST, args: ['serve', '--mcp'], stderr: 'inherit'}));
  try {
    await use(client);
  } finally {
    await client.close();
  }
}

test('tools are listed with schemas and answer', () => withClient(async (client) => {
  assert.equal(client.getServerVersion().name, 'holdfast');
  const {tools} = await client.listTools();
  for (const tool of tools) {
    assert.equal(tool.inputSchema.type, 'object');
    assert.ok(tool.description.length > 10, tool.name);
  }
  const checked = await client.callTool(
      {name: 'check', arguments: {structure: kArm, picture: true}});
  assert.equal(checked.structuredContent.verdict, 'safe');
  assert.match(checked.content[0].text, /^SAFE/);
  assert.equal(Buffer.from(checked.content[1].data, 'base64').subarray(1, 4).toString(), 'PNG');
}));

test('a plan goes from tool to tool', () => withClient(async (client) => {
  const made = await client.callTool({name: 'generate', arguments: {family: 'stairs', size: 3}});
  const stairs = JSON.parse(made.content[1].text);
  const order = await client.callTool({name: 'order', arguments: {target: stairs, output: true}});
  assert.equal(order.structuredContent.result, 'found');
  const judged = await client.callTool(
      {name: 'steps', arguments: {structure: order.content[1].text}});
  assert.equal(judged.structuredContent.verdict, 'safe');
  assert.equal(judged.structuredContent.steps.length, order.structuredContent.steps);
}));

test('what is wrong is an error of the tool, and the next call is answered',
    () => withClient(async (client) => {
  const wrong = await client.callTool({name: 'check', arguments: {structure: [[0, 0]]}});
  assert.ok(wrong.isError);
  assert.match(wrong.content[0].text, /three/);
  const unknown = await client.callTool({name: 'check', arguments: {structures: kArm}});
  assert.match(unknown.content[0].text, /did you mean 'structure'/);
  await assert.rejects(client.callTool({name: 'demolish', arguments: {}}), /unknown tool/);
  const right = await client.callTool({name: 'check', arguments: {structure: kArm}});
  assert.equal(right.isError, false);
}));

test('a long call tells its progress and can be aborted', () => withClient(async (client) => {
  const made = await client.callTool({name: 'generate', arguments: {family: 'cube', size: 14}});
  const target = JSON.parse(made.content[1].text);
  const abort = new AbortController();
  const told = [];
  await assert.rejects(client.callTool(
      {name: 'order', arguments: {target, exact: true, seconds: 300}}, undefined,
      {signal: abort.signal, onprogress: (progress) => {
        told.push(progress.message);
        abort.abort();
      }}));
  assert.equal(told.length, 1);
  await client.ping();
}));
