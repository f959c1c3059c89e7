// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { createHash } from 'node:crypto';
import { readFileSync, readdirSync } from 'node:fs';
import { deflateRawSync } from 'node:zlib';
import { defineConfig, transformWithEsbuild, type HtmlTagDescriptor, type Plugin } from 'vite';
import { toLetters } from './src/core/letters';
import { Core } from './src/core/wasm';

const repository = new URL('../../', import.meta.url);
const coreFile = new URL('build/wasm/holdfast_core.wasm', repository);
const scenarioFolder = new URL('scenarios/', repository);

/** Bytes in the page, deflated, as letters (src/core/letters.ts); src/core/packed.ts reads them. */
function element(id: string, bytes: Uint8Array): HtmlTagDescriptor {
  const packed = deflateRawSync(bytes, { level: 9 });
  return { tag: 'script', attrs: { id, type: 'text/plain', 'data-size': String(packed.length) }, children: toLetters(packed), injectTo: 'body' };
}

const markup = ({ tag, attrs, children }: HtmlTagDescriptor) =>
  `<${tag} ${Object.entries(attrs!).map(([name, value]) => `${name}="${value}"`).join(' ')}>${children as string}</${tag}>`;

/** Modules that are made from files of the repository, and of what the core says. */
function holdfastFiles(): Plugin {
  const makers: Record<string, () => unknown> = {
    'virtual:vocabulary': async () =>
      (await Core.create(await WebAssembly.compile(readFileSync(coreFile)))).vocabulary(),
    'virtual:scenarios': () =>
      Object.fromEntries(
        readdirSync(scenarioFolder)
          .filter((name) => name.endsWith('.json'))
          .map((name) => [
            name.replace('.json', ''),
            JSON.parse(readFileSync(new URL(name, scenarioFolder), 'utf8')),
          ]),
      ),
  };
  return {
    name: 'holdfast-files',
    resolveId: (id) => (id in makers ? `\0${id}` : undefined),
    transformIndexHtml: () => [element('holdfast-core', readFileSync(coreFile))],
    load: async (id) =>
      id.startsWith('\0virtual:') && id.slice(1) in makers
        ? `export default ${JSON.stringify(await makers[id.slice(1)]())};`
        : undefined,
  };
}

const sha256 = (text: string) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

/** The one script that the browser sees at first: it unpacks the page's own, whose hash the policy has too. */
async function openerScript(): Promise<string> {
  const source = readFileSync(new URL('src/opener.ts', import.meta.url), 'utf8');
  const packed = readFileSync(new URL('src/core/packed.ts', import.meta.url), 'utf8');
  const letters = readFileSync(new URL('src/core/letters.ts', import.meta.url), 'utf8');
  const whole = [letters, packed, source].join('\n').replace(/^import .*$/gm, '').replace(/^export /gm, '');
  return (await transformWithEsbuild(whole, 'opener.ts', { minify: true, format: 'esm', treeShaking: true })).code.trim();
}

/** One HTML file with script and style in it, and a policy that allows exactly these. */
function oneFile(): Plugin {
  return {
    name: 'holdfast-one-file',
    enforce: 'post',
    async generateBundle(_options, bundle) {
      let script = '';
      let style = '';
      for (const [name, file] of Object.entries(bundle)) {
        if (file.type === 'chunk') {
          script += file.code.trim().replaceAll('</script', '<\\/script');
        } else if (name.endsWith('.css')) {
          style += String(file.source).trim();
        } else {
          continue;
        }
        delete bundle[name];
      }
      const page = Object.values(bundle).find((file) => file.fileName === 'index.html');
      if (page?.type !== 'asset') {
        throw new Error('no index.html was made');
      }
      const opener = await openerScript();
      const policy = [
        "default-src 'none'",
        `script-src ${sha256(opener)} ${sha256(script)} 'wasm-unsafe-eval'`,
        `style-src ${sha256(style)}`,
        'worker-src blob:',
        'img-src blob: data:',
        "base-uri 'none'",
        "form-action 'none'",
      ].join('; ');
      const head = `<meta http-equiv="Content-Security-Policy" content="${policy}">`;
      page.source = String(page.source)
        .replace(/<script type="module"[^>]*><\/script>\s*/, '')
        .replace(/<link rel="stylesheet"[^>]*>\s*/, '')
        .replace('<meta charset="utf-8">', () => `<meta charset="utf-8">\n${head}`)
        .replace('</head>', () => `<style>${style}</style>\n</head>`)
        .replace('</body>', () => `${markup(element('holdfast-script', Buffer.from(script)))}\n<script type="module">${opener}</script>\n</body>`);
      page.fileName = 'holdfast.html';
    },
  };
}

export default defineConfig({
  plugins: [holdfastFiles(), oneFile()],
  worker: { plugins: () => [holdfastFiles()] },
  build: {
    outDir: '../../build/page',
    emptyOutDir: true,
    target: 'es2022',
    modulePreload: false,
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 4000,
  },
});
