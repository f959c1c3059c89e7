// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { copyFileSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { defineConfig, type Plugin } from 'vite';

const at = (path: string) => fileURLToPath(new URL(path, import.meta.url));
const folder = at('../../build/npm');

/** Declarations name the files that they import as Node has to find them. */
function completeImports(within: string): void {
  for (const entry of readdirSync(within, { withFileTypes: true })) {
    const path = join(within, entry.name);
    if (entry.isDirectory()) {
      completeImports(path);
    } else if (path.endsWith('.d.ts')) {
      const text = readFileSync(path, 'utf8');
      writeFileSync(path, text.replace(/(from ['"]\.[^'"]*)(['"])/g, '$1.js$2'));
    }
  }
}

/** What else is in the package: the core, the licence, who it is. */
function packageFiles(): Plugin {
  return {
    name: 'holdfast-package-files',
    closeBundle() {
      const version = /project\(holdfast VERSION ([0-9.]+)/.exec(readFileSync(at('../../CMakeLists.txt'), 'utf8'))?.[1];
      const about = JSON.parse(readFileSync(at('package/package.json'), 'utf8')) as object;
      writeFileSync(join(folder, 'package.json'), `${JSON.stringify({ ...about, version }, undefined, 2)}\n`);
      copyFileSync(at('package/README.md'), join(folder, 'README.md'));
      copyFileSync(at('../../LICENSE'), join(folder, 'LICENSE'));
      copyFileSync(at('../../build/wasm/holdfast_core.wasm'), join(folder, 'holdfast_core.wasm'));
      completeImports(join(folder, 'types'));
    },
  };
}

/** The package for Node and browsers: build/npm, after the declarations, which tsc has laid there. */
export default defineConfig({
  plugins: [packageFiles()],
  build: {
    outDir: folder,
    emptyOutDir: false,
    target: 'es2022',
    minify: false,
    lib: { entry: at('src/package/index.ts'), formats: ['es'], fileName: 'index' },
    rollupOptions: { external: ['node:fs/promises'] },
  },
});
