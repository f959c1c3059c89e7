// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import VOCABULARY from 'virtual:vocabulary';
import { CoreClient } from '../core/client';
import { Output, type OpenedDocument } from '../core/types';
import { EditedRobot } from '../model/edited_robot';
import { CUBIC, latticeOf } from '../model/lattice';
import { linkFragment, readFragment } from '../model/link';
import { withoutHead, type Surroundings } from '../model/surroundings';
import type { Workbench } from '../model/workbench';
import type { App } from './app';
import { byId, download, reasonOf, tell } from './dom';
import { ROLE_NAMES, cellText } from '../model/cell';
import { OBSTACLE } from '../view/colours';
import { glbOf } from '../view/solid';
import { gifOf } from './film';
import { makePoster } from './poster';
import { t } from '../texts';

/** Structures in and out: files, links, pictures, reports. Nothing that fails touches the robot. */

const FILE_BYTES_MAX = 256 << 20;
/** Browsers and mail programs cut longer links. */
const LINK_LENGTH_MAX = 32_000;

const client = new CoreClient();

export function robotOf(opened: OpenedDocument, text: string, fallbackName: string): EditedRobot {
  const { lattice, ...surroundings } = JSON.parse(opened.more) as Surroundings;
  const robot = EditedRobot.from(opened.modules, latticeOf(lattice ?? CUBIC.name)?.of(surroundings.material?.pitch_mm));
  robot.name = opened.name || fallbackName;
  robot.supportZ = opened.support_z;
  robot.material = opened.material;
  robot.surroundings = withoutHead(surroundings);
  robot.base = opened.base || text;
  robot.laterSteps = opened.later_steps;
  return robot;
}

/** A structure that takes longer to read is said to be read. */
const LATE_MS = 1000;

/** Puts a structure in place of the robot; what was there comes back with undo. */
export async function openText(
  bench: Workbench,
  bytes: Uint8Array,
  name: string,
  origin = name,
  fileName = '',
  meshPitch = 0,
): Promise<boolean> {
  // What is said of the file is not said behind a dialog.
  document.querySelectorAll('dialog[open]').forEach((dialog) => (dialog as HTMLDialogElement).close());
  let note: HTMLElement | undefined;
  const late = setTimeout(() => (note = tell(t('reading {0} …', origin), false, Infinity)), LATE_MS);
  try {
    const opened = await client.open(bytes, fileName, meshPitch).finally(() => clearTimeout(late));
    const robot = robotOf(opened, new TextDecoder().decode(bytes), name);
    bench.history.replace(t('opening {0}', robot.name || t('a structure')), robot);
    const notes = opened.warnings;
    if (notes.length > 0) {
      tell(`${origin}: ${notes.slice(0, 3).join('; ')}${notes.length > 3 ? '; …' : ''}`);
    }
    return true;
  } catch (error) {
    tell(`${origin}: ${reasonOf(error)}`, true);
    return false;
  } finally {
    note?.remove();
  }
}

export async function openFile(bench: Workbench, file: File): Promise<void> {
  if (file.size > FILE_BYTES_MAX) {
    const size = (file.size / 2 ** 20).toFixed(0);
    tell(t('{0}: {1} MiB, this page reads at most 256; the program holdfast reads more', file.name, size), true);
    return;
  }
  try {
    const bytes = new Uint8Array(await file.arrayBuffer());
    const pitch = meshPitchOf(file.name);
    if (pitch !== undefined) {
      await openText(bench, bytes, file.name.replace(/\.[^.]*$/, ''), file.name, file.name, pitch);
    }
  } catch {
    tell(t('{0}: cannot be read', file.name), true);
  }
}

/** What a mesh is filled with has an edge that only the user knows; undefined: it is not to be opened. */
function meshPitchOf(fileName: string): number | undefined {
  if (!/\.(stl|obj)$/i.test(fileName)) {
    return 0;
  }
  const answer = prompt(t('Edge of a module, in the unit of the mesh (mostly mm)'), '40');
  return answer === null ? undefined : Number(answer.replace(',', '.')) || 0;
}

export const BROKEN_LINK = t('the link is broken: it may have been cut; nothing was opened');

/** The structure in the page's address; undefined if there is none. Throws if it is broken. */
export async function openFragment(bench: Workbench): Promise<boolean | undefined> {
  const bytes = await readFragment(location.hash);
  return bytes && openText(bench, bytes, t('the link'));
}

export function listenToFiles(bench: Workbench): void {
  const input = byId<HTMLInputElement>('file');
  input.accept = VOCABULARY.endings.join();
  byId('open').onclick = () => input.click();
  input.onchange = () => {
    const file = input.files?.[0];
    input.value = '';
    if (file) {
      void openFile(bench, file);
    }
  };
  window.addEventListener('dragover', (event) => {
    event.preventDefault();
    byId('drop').hidden = false;
  });
  window.addEventListener('dragleave', (event) => {
    byId('drop').hidden = event.relatedTarget === null;
  });
  window.addEventListener('drop', (event) => {
    event.preventDefault();
    byId('drop').hidden = true;
    const file = event.dataTransfer?.files[0];
    if (file) {
      void openFile(bench, file);
    }
  });
  window.addEventListener('hashchange', () => openFragment(bench).catch(() => tell(BROKEN_LINK, true)));
}

export function write(bench: Workbench, output: Output): Promise<string> {
  const { robot } = bench;
  return client.write(robot.toData(true).data, output, robot.name, robot.base);
}

const fileName = (bench: Workbench) => bench.robot.name.replace(/[^\w.-]+/g, '_') || 'structure';

export async function take(app: App, what: string): Promise<void> {
  const { bench } = app;
  const save = async (output: Output, ending: string, type: string) =>
    download(`${fileName(bench)}.${ending}`, new Blob([await write(bench, output)], { type }));
  try {
    switch (what) {
      case 'json':
        return await save(Output.kJson, 'json', 'application/json');
      case 'xml':
        return await save(Output.kXml, 'xml', 'text/xml');
      case 'svg':
        return await save(Output.kSvg, 'svg', 'image/svg+xml');
      case 'png':
        return await savePng(app);
      case 'glb':
        return download(`${fileName(bench)}.glb`, await solidOf(app));
      case 'gif':
        return download(`${fileName(bench)}.gif`, await gifOf(app));
      case 'link':
        return await copyLink(bench);
      default:
        return await showReport(bench);
    }
  } catch (error) {
    tell(reasonOf(error), true);
  }
}

/** What is in the picture, where it stands. */
function solidOf({ robot, view, scenery: { obstacles } }: App): Promise<Blob> {
  const modules = view.solids().map(({ slot, place, colour }) => ({ name: `${ROLE_NAMES[robot.roleAt(slot)]} ${cellText(robot.cellAt(slot))}`, place, colour }));
  const blocks = obstacles.faces.visible ? obstacles.faces.geometry : undefined;
  return glbOf(robot.name, robot.lattice, robot.pitchMm, modules, blocks, OBSTACLE.contact);
}

async function savePng(app: App): Promise<void> {
  const blob = await makePoster(app);
  if (!blob) {
    throw new Error(t('the browser gives no picture'));
  }
  download(`${fileName(app.bench)}.png`, blob);
}

/** A page on a disk has no address that others know. */
const here = () => (location.protocol === 'file:' ? ` ${t('It opens on this computer only, as this page is a file here.')}` : '');

async function copyLink(bench: Workbench): Promise<void> {
  const fragment = await linkFragment(await write(bench, Output.kJson));
  if (fragment.length > LINK_LENGTH_MAX) {
    tell(t('too large for a link ({0} letters): save it as a file', fragment.length), true);
    return;
  }
  history.replaceState(null, '', fragment);
  try {
    await navigator.clipboard.writeText(location.href);
    tell(`${t('The link is copied; it holds the whole structure.')}${here()}`);
  } catch {
    tell(`${t('The link is in the address bar; it holds the whole structure.')}${here()}`);
  }
}

/** A report of a structure file, by the same calls as everything on the page. */
export async function reportOf(source: string, name: string, output = Output.kReportJson): Promise<string> {
  const robot = robotOf(await client.open(new TextEncoder().encode(source)), source, name);
  return client.write(robot.toData(true).data, output, robot.name, source);
}

async function showReport(bench: Workbench): Promise<void> {
  byId('report-text').textContent = await write(bench, Output.kReportText);
  byId<HTMLDialogElement>('takeaway').close();
  byId<HTMLDialogElement>('report').showModal();
}
