// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { LineBasicMaterial, LineSegments, type BufferGeometry } from 'three';
import { mergeGeometries } from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import type { Cell } from '../model/cell';
import type { Lattice } from '../model/lattice';
import { cellEdges } from './polyhedron';

/** Cells that a module is to be in: their edges, seen through the robot. */

const SIZE = 0.94;

export class GoalView {
  readonly lines = new LineSegments<BufferGeometry, LineBasicMaterial>(
    undefined,
    new LineBasicMaterial({ color: 0xb8860b, depthTest: false, transparent: true }),
  );

  constructor() {
    this.lines.visible = false;
    this.lines.renderOrder = 4;
  }

  show(lattice: Lattice, cells: readonly Cell[]): void {
    this.lines.visible = cells.length > 0;
    if (cells.length > 0) {
      this.lines.geometry.dispose();
      this.lines.geometry = mergeGeometries(cells.map((cell) => cellEdges(lattice, SIZE).translate(...lattice.place(cell))));
    }
  }
}
