// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import {
  BufferGeometry, Color, Group, Mesh, MeshStandardMaterial, SRGBColorSpace, SphereGeometry, type BufferAttribute,
} from 'three';
import { GLTFExporter } from 'three/examples/jsm/exporters/GLTFExporter.js';
import type { Lattice, Place } from '../model/lattice';
import { hex, type Rgb } from './colours';
import { shapeGeometry } from './shapes';

/** The robot as a glTF file for other programs: in metres, y up, a node for each module that is seen. */

export interface SolidModule {
  name: string;
  /** In pitches. */
  place: Place;
  colour: Rgb;
}

/** Without what only the page's shaders read. */
function plain(geometry: BufferGeometry): BufferGeometry {
  const copy = new BufferGeometry();
  copy.setIndex(geometry.index);
  for (const name of ['position', 'normal']) {
    copy.setAttribute(name, geometry.attributes[name] as BufferAttribute);
  }
  return copy;
}

const materialOf = (colour: Rgb) =>
  new MeshStandardMaterial({ color: new Color().setHex(hex(colour), SRGBColorSpace), roughness: 0.8, metalness: 0 });

export async function glbOf(name: string, lattice: Lattice, pitchMm: number, modules: readonly SolidModule[], obstacles?: BufferGeometry, obstacleColour?: Rgb): Promise<Blob> {
  const root = new Group();
  root.name = name || 'robot';
  root.rotation.x = -Math.PI / 2;
  root.scale.setScalar(pitchMm / 1000);
  const shape = plain(lattice.shape === 'sphere' ? new SphereGeometry(0.5, 24, 16) : shapeGeometry(lattice));
  const materials = new Map<number, MeshStandardMaterial>();
  for (const module of modules) {
    const code = hex(module.colour);
    const material = materials.get(code) ?? materialOf(module.colour);
    materials.set(code, material);
    const mesh = new Mesh(shape, material);
    mesh.name = module.name;
    mesh.position.fromArray(module.place);
    root.add(mesh);
  }
  if (obstacles && obstacleColour) {
    const mesh = new Mesh(plain(obstacles), materialOf(obstacleColour));
    mesh.name = 'obstacles';
    root.add(mesh);
  }
  const file = await new GLTFExporter().parseAsync(root, { binary: true });
  return new Blob([file as ArrayBuffer], { type: 'model/gltf-binary' });
}
