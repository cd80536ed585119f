// A canvas that shows a progressive mesh: camera, orbit controls, surface and cut. Draws only when something changed.

import {Group, MathUtils, PerspectiveCamera, Quaternion, Scene, Spherical, Vector3, WebGLRenderer} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import type {ColorMapName} from '../core/color_maps';
import type {Snapshot} from '../core/worker_messages';
import {SoupMesh} from './soup_mesh';

const kFieldOfViewDegrees = 32;
/** From where a mesh is first seen: front right, from above; z is up. */
const kFirstDirection = new Vector3(0.62, -1, 0.55).normalize();
const kUp = new Vector3(0, 0, 1);
/** How dark cell edges are: enough to follow, not enough to change what a colour says. */
const kEdgeStrength = 0.52;
/** Air round a mesh that has just been fitted. */
const kMargin = 1.16;
/** Pixels beyond two a point cost more than they show. */
const kMostPixelRatio = 2;

/** Shares of the canvas that panels cover, each in [0, 1); the mesh is centred in what remains. */
export interface Insets {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

export class MeshView {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(kFieldOfViewDegrees, 1, 0.01, 100);
  private readonly controls: OrbitControls;
  /** From lattice coordinates to a ball of radius 1 round the origin. */
  private readonly lattice = new Group();
  private readonly surface = new SoupMesh(true);
  private readonly cap = new SoupMesh(false);
  private readonly resizes: ResizeObserver;
  private bounds: number[] = [];
  private insets: Insets = {left: 0, right: 0, top: 0, bottom: 0};
  /** Until somebody turns or zooms, the mesh stays fitted to the space that there is. */
  private fitted = true;
  private frame = 0;
  private afterFrame: (() => void)[] = [];

  /** Throws when the browser has no WebGL 2. `turned` is called with the camera's rotation whenever it changes. */
  constructor(readonly canvas: HTMLCanvasElement, private readonly turned: (rotation: Quaternion) => void = () => undefined) {
    this.renderer = new WebGLRenderer({canvas, antialias: true, alpha: true, powerPreference: 'high-performance'});
    this.renderer.setClearColor(0, 0);
    this.camera.up.copy(kUp);
    this.camera.position.copy(kFirstDirection).multiplyScalar(4);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.invalidate());
    this.controls.addEventListener('start', () => void (this.fitted = false));
    this.lattice.add(this.surface, this.cap);
    this.scene.add(this.lattice);
    this.resizes = new ResizeObserver(() => this.resize());
    this.resizes.observe(canvas);
    this.resize();
  }

  /** Shows the picture; `drawn` is called after the frame that holds it. */
  show(snapshot: Snapshot, drawn: () => void): void {
    if (snapshot.surface) this.surface.show(snapshot.surface);
    if (snapshot.cut !== undefined) {
      this.cap.show(snapshot.cut?.cap ?? null);
      this.surface.material.setClip(snapshot.cut?.plane ?? null);
    }
    if (this.bounds.length === 0 && snapshot.bounds.length > 0) {
      this.bounds = snapshot.bounds;
      this.placeLattice();
      this.resetCamera();
    }
    this.afterFrame.push(drawn);
    this.invalidate();
  }

  /** Forgets the mesh; the next one is fitted anew. */
  clear(): void {
    this.bounds = [];
    this.surface.show(null);
    this.cap.show(null);
    this.surface.material.setClip(null);
    this.invalidate();
  }

  setColorMap(name: ColorMapName): void {
    for (const mesh of [this.surface, this.cap]) mesh.material.setColorMap(name);
    this.invalidate();
  }

  setEdges(on: boolean): void {
    for (const mesh of [this.surface, this.cap]) mesh.material.setEdges(on ? kEdgeStrength : 0);
    this.invalidate();
  }

  setInsets(insets: Insets): void {
    this.insets = insets;
    this.resize();
  }

  /** The view that a mesh is first seen in: as near as its bounding box allows. */
  resetCamera(): void {
    this.fitted = true;
    if (this.bounds.length === 0) return;
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(kFirstDirection);
    this.camera.lookAt(0, 0, 0);
    this.camera.position.multiplyScalar(this.fittingDistance());
    this.controls.update();
    this.invalidate();
  }

  /** Turns the camera round its target, in radians. */
  orbit(horizontal: number, vertical: number): void {
    this.fitted = false;
    const toYUp = new Quaternion().setFromUnitVectors(kUp, new Vector3(0, 1, 0));
    const offset = this.camera.position.clone().sub(this.controls.target).applyQuaternion(toYUp);
    const spherical = new Spherical().setFromVector3(offset);
    spherical.theta += horizontal;
    spherical.phi += vertical;
    spherical.makeSafe();
    offset.setFromSpherical(spherical).applyQuaternion(toYUp.invert());
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.invalidate();
  }

  /** Moves the camera: below 1 nearer, above 1 farther. */
  zoom(factor: number): void {
    this.fitted = false;
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.invalidate();
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    this.resizes.disconnect();
    this.controls.dispose();
    this.surface.dispose();
    this.cap.dispose();
    this.renderer.dispose();
  }

  private placeLattice(): void {
    const low = new Vector3(...this.bounds.slice(0, 3) as [number, number, number]);
    const high = new Vector3(...this.bounds.slice(3, 6) as [number, number, number]);
    const scale = 2 / Math.max(low.distanceTo(high), 1);
    this.lattice.scale.setScalar(scale);
    this.lattice.position.copy(low.add(high)).multiplyScalar(-0.5 * scale);
  }

  /** How far the turned camera must stand for every corner of the bounds to fall into what the panels leave free. */
  private fittingDistance(): number {
    const tanHeight = Math.tan(MathUtils.degToRad(kFieldOfViewDegrees) / 2) * (1 - this.insets.top - this.insets.bottom);
    const tanWidth = Math.tan(MathUtils.degToRad(kFieldOfViewDegrees) / 2) * this.camera.aspect * (1 - this.insets.left - this.insets.right);
    const right = new Vector3();
    const up = new Vector3();
    const near = new Vector3();
    this.camera.updateMatrixWorld();
    this.camera.matrixWorld.extractBasis(right, up, near);
    let distance = 1;
    for (let i = 0; i < 8; ++i) {
      const corner = new Vector3(this.bounds[i & 1 ? 3 : 0], this.bounds[i & 2 ? 4 : 1], this.bounds[i & 4 ? 5 : 2]);
      corner.multiply(this.lattice.scale).add(this.lattice.position);
      const across = Math.max(Math.abs(corner.dot(right)) / tanWidth, Math.abs(corner.dot(up)) / tanHeight);
      distance = Math.max(distance, across * kMargin + corner.dot(near));
    }
    return distance;
  }

  private resize(): void {
    const width = Math.max(this.canvas.clientWidth, 1);
    const height = Math.max(this.canvas.clientHeight, 1);
    const ratio = Math.min(window.devicePixelRatio, kMostPixelRatio);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    for (const mesh of [this.surface, this.cap]) mesh.material.setPixelRatio(ratio);
    this.camera.aspect = width / height;
    // Shifts the picture's centre into the middle of what the panels leave free.
    const right = (this.insets.right - this.insets.left) / 2 * width;
    const down = (this.insets.bottom - this.insets.top) / 2 * height;
    this.camera.setViewOffset(width, height, right, down, width, height);
    this.camera.updateProjectionMatrix();
    if (this.fitted) this.resetCamera();
    this.draw();  // at once: a resized canvas is empty until it is drawn
  }

  private invalidate(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.draw());
  }

  private draw(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.renderer.render(this.scene, this.camera);
    this.turned(this.camera.quaternion);
    const done = this.afterFrame;
    this.afterFrame = [];
    for (const drawn of done) drawn();
  }
}
