// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import { DoubleSide, Mesh, MeshBasicMaterial, Vector3, type BufferGeometry } from 'three';
import { mergeGeometries } from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import { FACET_FIELDS, type Answer } from '../core/types';
import type { EditedRobot } from '../model/edited_robot';
import { arrowAlong } from './arrow';
import { FacetState, facetAt, facetCount, facetFrame } from './facets';

/** What the ground and obstacles do to the modules that they touch: an arrow to where each facet is pressed. */

/** Of the largest, in cells; smaller ones in proportion, but seen. */
const LENGTH = 1.3;
const LENGTH_MIN = 0.25;
/** Below this share of the largest a force is none. */
const NOTHING = 1e-6;

export interface Reaction {
  module: number;
  /** On the module, in N. */
  force: Vector3;
  /** In cells: the middle of the facet, or of the edge or the corner that presses alone. */
  place: Vector3;
}

/** Of all facets that press or are bonded; none where the forces are not known. */
export function reactionsOf(robot: EditedRobot, answer: Answer, slots: Int32Array): Reaction[] {
  const half = answer.facet_half_mm / robot.pitchMm;
  const all = Array.from({ length: answer.facetForces.length > 0 ? facetCount(answer) : 0 }, (_, i) => {
    const { module, direction, state, pressed, push } = facetAt(answer, i);
    const normal = new Vector3().fromArray(robot.lattice.units[direction]);
    const along = new Vector3().fromArray(answer.facetForces, FACET_FIELDS * i + 1);
    const place = new Vector3().fromArray(robot.placeAt(slots[module])).addScaledVector(normal, robot.lattice.halves[direction]);
    facetFrame(robot.lattice.units[direction]).forEach((axis, k) => place.addScaledVector(new Vector3().fromArray(axis), half * pressed[k]));
    return { module, state, force: along.addScaledVector(normal, -push), place };
  });
  const largest = Math.max(0, ...all.map(({ force }) => force.length()));
  return all.filter(({ state, force }) => state !== FacetState.kOpen && force.length() > NOTHING * largest);
}

export class ReactionView {
  readonly mesh = new Mesh<BufferGeometry, MeshBasicMaterial>(
    undefined,
    new MeshBasicMaterial({ side: DoubleSide, transparent: true, opacity: 0.9, depthTest: false }),
  );

  constructor() {
    this.mesh.renderOrder = 4;
    this.mesh.visible = false;
  }

  setInk(ink: number): void {
    this.mesh.material.color.setHex(ink);
  }

  show(reactions: readonly Reaction[]): void {
    this.mesh.visible = reactions.length > 0;
    if (reactions.length > 0) {
      const largest = Math.max(...reactions.map(({ force }) => force.length()));
      const signs = reactions.map(({ force, place }) => {
        const length = Math.max(LENGTH_MIN, (LENGTH * force.length()) / largest);
        return arrowAlong(force, length, place);
      });
      this.mesh.geometry.dispose();
      this.mesh.geometry = mergeGeometries(signs);
    }
  }
}
