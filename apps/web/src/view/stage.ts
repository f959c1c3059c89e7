// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
import {
  Group,
  MOUSE,
  OrthographicCamera,
  PerspectiveCamera,
  Quaternion,
  Raycaster,
  Scene,
  TOUCH,
  Vector2,
  Vector3,
  WebGLRenderer,
  type Ray,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Place } from '../model/lattice';

/** From a connection that is looked at, in cells, and how long the way there takes. */
const NEAR = 14;
const FLIGHT_MS = 350;

const UPRIGHT = new Vector3(0, 0, 1);

/** From where the robot is seen at first: from the front, right and above. */
export const OBLIQUE: Place = [0.62, -0.62, 0.48];

/** Moves something to where it is at a time; true while it goes on moving. */
export type Motion = (now: number) => boolean;

/** The one canvas: renderer, camera and its controls. Draws only when something has changed. */
export class Stage {
  readonly scene = new Scene();
  /** What topples. */
  readonly robot = new Group();
  /** What the controls move, whichever projection shows it. */
  readonly camera = new PerspectiveCamera(32, 1, 0.1, 5000);
  /** Follows the camera where parallels are to stay parallel. */
  private readonly parallel = new OrthographicCamera();
  private isParallelWanted = false;
  /** Half of what was fitted last, in cells. */
  private reach = 10;
  /** Another one wherever up is another direction. */
  controls!: OrbitControls;
  private readonly renderer: WebGLRenderer;
  private readonly raycaster = new Raycaster();
  private frame = 0;
  /** The camera's way, while it goes. */
  private flight?: Motion;
  /** Nothing is drawn before there is something to see. */
  isReady = false;
  /** What moves: called before each frame with its time. */
  readonly motions: Motion[] = [];
  /** What follows the picture: called after each frame. */
  readonly followers: (() => void)[] = [];

  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly covered: () => { top: number; bottom: number },
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setClearAlpha(0);
    // Asking for errors waits for the compiler; the tests look at the picture instead.
    this.renderer.debug.checkShaderErrors = false;
    this.camera.up.copy(UPRIGHT);
    this.control(new Vector3());
    this.scene.add(this.robot);
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  /** Asks for a frame. */
  draw(): void {
    if (!this.isReady) {
      return;
    }
    this.frame ||= requestAnimationFrame((now) => {
      this.frame = 0;
      this.drawFrame(now);
    });
  }

  /** What a frame does: motions go on, all is drawn, and what follows the camera comes after. */
  drawFrame(now: number): void {
    if (this.flight && !this.flight(now)) {
      this.flight = undefined;
    }
    const moving = this.motions.filter((motion) => motion(now));
    this.render();
    this.followers.forEach((follow) => follow());
    if (moving.length > 0 || this.flight) {
      this.draw();
    }
  }

  /** Draws now, without waiting for a frame. */
  render(): void {
    this.renderer.render(this.scene, this.eye());
  }

  /** The picture with so many pixels for each that it has now, by its pixel ratio and width. */
  picture(scaleOf: (ratio: number, width: number) => number): { canvas: HTMLCanvasElement; ratio: number } {
    const ratio = this.renderer.getPixelRatio();
    const { clientWidth, clientHeight } = this.canvas;
    const scale = scaleOf(ratio, clientWidth);
    const copy = document.createElement('canvas');
    this.renderer.setPixelRatio(ratio * scale);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.render();
    [copy.width, copy.height] = [this.canvas.width, this.canvas.height];
    copy.getContext('2d')!.drawImage(this.canvas, 0, 0);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.render();
    return { canvas: copy, ratio: ratio * scale };
  }

  /** Orthographic: equal lengths are equal in the picture, however far away. */
  get isParallel(): boolean {
    return this.isParallelWanted;
  }

  set isParallel(isParallel: boolean) {
    this.isParallelWanted = isParallel;
    this.draw();
  }

  /**
   * What sees the scene. The orthographic camera shows what the other one does in the plane of its target, so that
   * turning, panning and zooming are the same; it stands so far back that no module is behind it.
   */
  private eye(): PerspectiveCamera | OrthographicCamera {
    const { camera, parallel } = this;
    camera.updateMatrixWorld();
    if (!this.isParallelWanted) {
      return camera;
    }
    const distance = camera.position.distanceTo(this.controls.target);
    const half = distance * Math.tan((camera.fov * Math.PI) / 360);
    [parallel.top, parallel.bottom] = [half, -half];
    [parallel.right, parallel.left] = [half * camera.aspect, -half * camera.aspect];
    const back = 4 * this.reach;
    parallel.near = 0;
    parallel.far = distance + camera.far + back;
    parallel.view = camera.view;
    parallel.quaternion.copy(camera.quaternion);
    parallel.position.set(0, 0, back).applyQuaternion(camera.quaternion).add(camera.position);
    parallel.updateProjectionMatrix();
    parallel.updateMatrixWorld();
    return parallel;
  }

  get drawCalls(): number {
    return this.renderer.info.render.calls;
  }

  /** The ray under a point of the window. */
  ray(x: number, y: number): Ray {
    const box = this.canvas.getBoundingClientRect();
    const at = new Vector2(
      (2 * (x - box.left)) / box.width - 1,
      1 - (2 * (y - box.top)) / box.height,
    );
    this.raycaster.setFromCamera(at, this.eye());
    return this.raycaster.ray;
  }

  /** Where a point of the scene is on the canvas, in CSS pixels; undefined behind the camera. */
  project(point: Vector3): { x: number; y: number } | undefined {
    const at = point.clone().project(this.eye());
    const { clientWidth, clientHeight } = this.canvas;
    return at.z > 1
      ? undefined
      : { x: ((at.x + 1) / 2) * clientWidth, y: ((1 - at.y) / 2) * clientHeight };
  }

  /** The camera stands upright in the field of gravity, so that a floor is seen as steep as it is. */
  setGravity(gravity: readonly number[]): void {
    const up = new Vector3().fromArray(gravity).negate().normalize();
    if (up.lengthSq() === 0 || up.distanceToSquared(this.camera.up) < 1e-12) {
      return;
    }
    const { target } = this.controls;
    const turn = new Quaternion().setFromUnitVectors(this.camera.up, up);
    this.camera.position.sub(target).applyQuaternion(turn).add(target);
    this.camera.up.copy(up);
    this.controls.dispose();
    this.control(target);
    this.draw();
  }

  /** The camera's angle in plan, around z, in rad: 0 as seen from -y. */
  get azimuth(): number {
    const { x, y } = this.camera.position.clone().sub(this.controls.target);
    return Math.atan2(x, -y);
  }

  /** Where the eye is from what it looks at, of length one. */
  get side(): Vector3 {
    return this.camera.position.clone().sub(this.controls.target).normalize();
  }

  /** Looks at a box of nodes from a side, given where up is z; from the same one as now if it is undefined. */
  fit(low: Place, high: Place, from?: Place): void {
    const middle = new Vector3().fromArray(low.map((value, k) => (value + high[k]) / 2));
    const radius = 0.5 * Math.hypot(...low.map((value, k) => high[k] - value + 1.6));
    this.reach = radius;
    const half = (this.camera.fov * Math.PI) / 360;
    const narrow = Math.min(half, Math.atan(Math.tan(half) * this.camera.aspect));
    const side = from
      ? new Vector3().fromArray(from).normalize().applyQuaternion(new Quaternion().setFromUnitVectors(UPRIGHT, this.camera.up))
      : this.side;
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(side, (1.02 * radius) / Math.sin(narrow));
    this.camera.near = Math.max(0.05, radius / 200);
    this.camera.far = 200 * radius + 200;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  /** Goes near a point, from the side from which the robot is seen; at once for who wants no motion. */
  flyTo(point: Vector3): void {
    const { camera, controls } = this;
    const from = { target: controls.target.clone(), position: camera.position.clone() };
    const way = from.position.clone().sub(from.target);
    const to = point.clone().add(way.clampLength(0, NEAR));
    const begun = performance.now();
    const ms = matchMedia('(prefers-reduced-motion: reduce)').matches ? 0 : FLIGHT_MS;
    this.flight = (now) => {
      const share = ms === 0 ? 1 : Math.min(Math.max((now - begun) / ms, 0), 1);
      const soft = share * share * (3 - 2 * share);
      controls.target.lerpVectors(from.target, point, soft);
      camera.position.lerpVectors(from.position, to, soft);
      controls.update();
      return share < 1;
    };
    this.draw();
  }

  /** All of a box of nodes is in the picture. */
  holds(low: Place, high: Place): boolean {
    const { clientWidth, clientHeight } = this.canvas;
    return Array.from({ length: 8 }, (_, corner) =>
      this.project(new Vector3().fromArray(low.map((value, k) => ((corner >> k) & 1 ? high[k] + 0.5 : value - 0.5)))),
    ).every((at) => at && at.x >= 0 && at.x <= clientWidth && at.y >= 0 && at.y <= clientHeight);
  }

  /** Controls read once what is up. */
  private control(target: Vector3): void {
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
    this.controls.touches = { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
    this.controls.maxPolarAngle = 0.62 * Math.PI;
    this.controls.zoomToCursor = true;
    this.controls.target.copy(target);
    this.controls.addEventListener('change', () => this.draw());
    this.controls.update();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(Math.max(clientWidth, 1), Math.max(clientHeight, 1), false);
    // The verdict and the tools cover the upper and the lower part: the middle of the picture is that of the rest.
    const { top, bottom } = this.covered();
    const share = Math.min(1, clientHeight / 2 / Math.max(top + bottom, 1));
    const [width, height] = [Math.max(clientWidth, 1), Math.max(clientHeight - share * (top + bottom), 1)];
    this.camera.aspect = width / height;
    this.camera.setViewOffset(width, height, 0, -share * top, width, clientHeight);
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}
