// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import type { Finding } from '../core/judge';
import type { EditedRobot } from '../model/edited_robot';
import { FacetView } from '../view/facets';
import { Ground } from '../view/ground';
import { LoadView } from '../view/loads';
import { ObstacleView } from '../view/obstacles';
import type { RobotView } from '../view/robot_view';
import type { Stage } from '../view/stage';
import { setTheme } from './theme';

/** What stands around the robot in the picture: ground, obstacles, the facets that touch them, loads. */
export class Scenery {
  readonly ground = new Ground();
  readonly obstacles = new ObstacleView();
  readonly facets = new FacetView();
  private readonly loads = new LoadView();
  /** What is drawn in the colour of writing. */
  private readonly inked: { setInk(ink: number): void }[] = [this.obstacles, this.loads];

  constructor(stage: Stage) {
    stage.robot.add(this.loads.group);
    stage.scene.add(this.ground.group, this.obstacles.group, this.facets.mesh);
  }

  show(robot: EditedRobot, finding: Finding | undefined): void {
    const { low, high } = robot.bounds() ?? { low: [0, 0, 0], high: [0, 0, 0] };
    const reach = Math.max(high[0] - low[0], high[1] - low[1]) + 10;
    this.ground.place(robot.floorHeight, [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2], reach, robot.lattice.stretch, robot.hasFloor);
    this.ground.show(robot, finding?.answer?.stability);
    this.obstacles.show(robot);
    this.loads.show(robot);
    this.facets.show(robot, finding?.answer && { answer: finding.answer, slots: finding.slots });
  }

  /** Another thing in the colour of writing, from the next setTheme() on. */
  addInked(one: { setInk(ink: number): void }): void {
    this.inked.push(one);
  }

  setTheme(view: RobotView): void {
    setTheme(view, this.ground, this.inked);
  }
}
