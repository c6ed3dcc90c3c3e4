// The three-dimensional picture of the replay. Millimetres, z up.
import {
  Box3, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, Group, HemisphereLight, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshLambertMaterial, PerspectiveCamera, Plane, Quaternion, Scene, Sphere, Vector3, WebGLRenderer, type IUniform,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { sidesFor, sweep, type BeadMesh, type Sections } from './beads';
import { styleColour, type Rgb } from './colours';
import { Machine, formGeometry, meshGeometry, pose, poseAt } from './machine';
import type { ReplayData } from './record';
import type { Run } from './run';

/** Where a browser has no WebGL. */
export class NoWebGl extends Error {}

export class Stage {
  readonly machine: Machine;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly world = new Group();
  private readonly camera = new PerspectiveCamera(30, 1, 0.5, 6000);
  private readonly controls: OrbitControls;
  private readonly now: IUniform<number> = { value: 0 };
  private readonly cut = new Plane(new Vector3(0, -1, 0), 0);
  private readonly cutMaterials: MeshLambertMaterial[] = [];
  private readonly beadMesh: BeadMesh | null = null;
  private readonly beadColour: BufferAttribute | null = null;
  private readonly printed = new Box3();
  private errorLines: LineSegments[] = [];
  private following = false;
  private cutting = false;
  private cutAxis = new Vector3(0, 1, 0);
  private cutAt = 0;
  private asked = false;
  private looking = 'all';  // until the reader turns the view himself
  private readonly place = new Vector3();
  private readonly turn = new Quaternion();

  constructor(readonly canvas: HTMLCanvasElement, data: ReplayData, private readonly run: Run, sections: Sections | null) {
    try {
      this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: 'high-performance' });
    } catch {
      throw new NoWebGl();
    }
    this.renderer.localClippingEnabled = true;
    this.camera.up.set(0, 0, 1);
    this.scene.add(this.world, new HemisphereLight(0xffffff, 0x8d949c, 1.7));
    for (const [x, y, z, strength] of [[0.5, -0.8, 1.2, 1.6], [-0.9, 0.2, 0.5, 0.5]]) {
      const lamp = new DirectionalLight(0xffffff, strength);
      lamp.position.set(x, y, z);
      this.scene.add(lamp);
    }
    this.machine = new Machine(data);
    this.world.add(this.machine.root);
    if (data.table) {
      const table = new Mesh(formGeometry(data.table.form), new MeshLambertMaterial({ color: 0xc9cdd2 }));
      pose(table, data.table.pose);
      this.world.add(table);
    }
    if (data.part) {
      const part = new Mesh(meshGeometry(data.part), this.cutMaterial({ color: 0xb9c4bd, side: DoubleSide }));
      this.world.add(part);
      this.printed.expandByObject(part);
    }
    if (sections && sections.count > 0) {
      this.beadMesh = sweep(sections, sidesFor(sections.count));
      this.beadColour = new BufferAttribute(new Uint8Array(3 * this.beadMesh.time.length), 3, true);
      this.world.add(this.beadObject(this.beadMesh, this.beadColour));
    }
    this.world.add(this.pathToCome());
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.ask());
    this.controls.addEventListener('start', () => { this.looking = ''; });
    this.setTheme();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
  }

  private cutMaterial(settings: ConstructorParameters<typeof MeshLambertMaterial>[0]): MeshLambertMaterial {
    const material = new MeshLambertMaterial(settings);
    this.cutMaterials.push(material);
    return material;
  }

  /** What is laid later than now is not there: the front grows smoothly, whatever a section spans. */
  private grow(material: MeshLambertMaterial | LineBasicMaterial, keep: string) {
    material.onBeforeCompile = (shader) => {
      shader.uniforms.uNow = this.now;
      shader.vertexShader = 'attribute float laidAt;\nvarying float vLaidAt;\n' + shader.vertexShader.replace('#include <begin_vertex>', '#include <begin_vertex>\nvLaidAt = laidAt;');
      shader.fragmentShader = 'uniform float uNow;\nvarying float vLaidAt;\n' + shader.fragmentShader.replace('void main() {', 'void main() {\nif (!(vLaidAt ' + keep + ' uNow)) discard;');
    };
  }

  private beadObject(mesh: BeadMesh, colour: BufferAttribute): Mesh {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(mesh.position, 3));
    geometry.setAttribute('normal', new BufferAttribute(mesh.normal, 3, true));
    geometry.setAttribute('laidAt', new BufferAttribute(mesh.time, 1));
    geometry.setAttribute('color', colour);
    geometry.setIndex(new BufferAttribute(mesh.index, 1));
    geometry.computeBoundingBox();
    geometry.computeBoundingSphere();
    this.printed.union(geometry.boundingBox!);
    const material = this.cutMaterial({ vertexColors: true, side: DoubleSide });
    this.grow(material, '<=');
    return new Mesh(geometry, material);
  }

  private pathToCome(): LineSegments {
    const { time, extruding, tool } = this.run;
    const places: number[] = [], times: number[] = [];
    for (let i = 1; i < time.length; ++i) {
      if (!extruding[i]) continue;
      places.push(...tool.place.subarray(3 * i - 3, 3 * i + 3));
      times.push(time[i - 1], time[i]);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(Float32Array.from(places), 3));
    geometry.setAttribute('laidAt', new BufferAttribute(Float32Array.from(times), 1));
    const material = new LineBasicMaterial({ color: 0x9a4a1c, transparent: true, opacity: 0.75 });
    this.grow(material, '>');
    return new LineSegments(geometry, material);
  }

  paint(colourOf: (section: number) => Rgb) {
    if (!this.beadMesh || !this.beadColour) return;
    const { section } = this.beadMesh, colours = this.beadColour.array as Uint8Array, linear = new Color();
    let last = -1, r = 0, g = 0, b = 0;
    for (let v = 0; v < section.length; ++v) {
      if (section[v] !== last) {
        last = section[v];
        const [red, green, blue] = colourOf(last);
        linear.setRGB(red / 255, green / 255, blue / 255, 'srgb');
        r = 255 * linear.r; g = 255 * linear.g; b = 255 * linear.b;
      }
      colours[3 * v] = r; colours[3 * v + 1] = g; colours[3 * v + 2] = b;
    }
    this.beadColour.needsUpdate = true;
    this.ask();
  }

  show(time: number) {
    this.now.value = time;
    poseAt(this.run.tool, this.run.time, time, this.place, this.turn);
    this.machine.show(time, this.place, this.turn);
    const level = this.machine.level(time);
    this.world.matrixAutoUpdate = false;
    this.world.matrix.copy(level);
    this.moveCut(level);
    if (this.following) {
      const tip = this.place.clone().applyMatrix4(level);
      const shift = tip.clone().sub(this.controls.target);
      this.controls.target.copy(tip);
      this.camera.position.add(shift);
    }
    this.ask();
  }

  private moveCut(level: Matrix4) {
    this.cut.setFromNormalAndCoplanarPoint(this.cutAxis.clone().negate(), this.cutAxis.clone().multiplyScalar(this.cutAt)).applyMatrix4(level);
  }

  /** Cuts beads and part at a share of their extent along x, y or z; nothing where the axis is empty. */
  section(axis: string, share: number) {
    this.cutting = axis !== '';
    if (this.cutting && !this.printed.isEmpty()) {
      const i = 'xyz'.indexOf(axis);
      this.cutAxis.set(i === 0 ? 1 : 0, i === 1 ? 1 : 0, i === 2 ? 1 : 0);
      // From the side that the eye is on: what is nearer goes away.
      const low = this.printed.min.getComponent(i), high = this.printed.max.getComponent(i);
      if (axis === 'y') this.cutAxis.negate();
      this.cutAt = axis === 'y' ? -(low + (1 - share) * (high - low)) : low + share * (high - low);
    }
    for (const material of this.cutMaterials) {
      material.clippingPlanes = this.cutting ? [this.cut] : [];
      material.needsUpdate = true;
    }
    this.show(this.now.value);
  }

  follow(on: boolean) {
    this.following = on;
    if (on && this.camera.position.distanceTo(this.controls.target) > 60) this.look('tool');
    this.show(this.now.value);
  }

  /** The programmed path, and the true one with its error drawn `times` as large; 0 takes both away. */
  exaggerate(columns: Record<string, (number | null)[]>, times: number) {
    for (const line of this.errorLines) { this.world.remove(line); line.geometry.dispose(); }
    this.errorLines = [];
    const names = ['x_mm', 'y_mm', 'z_mm'], extruding = columns.extruding, laidAt = columns.time_s as number[];
    for (const [factor, colour] of times > 0 ? [[0, 0x3c444b], [times, 0xc2187a]] : []) {
      const places: number[] = [], instants: number[] = [];
      for (let i = 1; i < laidAt.length; ++i) {
        if (!extruding[i]) continue;
        for (const k of [i - 1, i]) {
          for (const name of names) {
            const asked = columns['programmed_' + name][k] as number;
            places.push(asked + factor * ((columns[name][k] as number) - asked));
          }
          instants.push(laidAt[k]);
        }
      }
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(Float32Array.from(places), 3));
      geometry.setAttribute('laidAt', new BufferAttribute(Float32Array.from(instants), 1));
      const material = new LineBasicMaterial({ color: colour, depthTest: false, transparent: true });
      this.grow(material, '<=');
      const line = new LineSegments(geometry, material);
      line.renderOrder = 2;
      this.errorLines.push(line);
      this.world.add(line);
    }
    this.ask();
  }

  /** all, part or tool. */
  look(at: string) {
    this.looking = at;
    const level = this.world.matrix;
    this.world.updateMatrixWorld(true);
    const ball = new Sphere();
    let nearer = 1;
    if (at === 'tool') ball.set(this.place.clone().applyMatrix4(level), 9);
    else if (at === 'part' && !this.printed.isEmpty()) this.printed.clone().applyMatrix4(level).getBoundingSphere(ball);
    else { new Box3().setFromObject(this.machine.root).union(new Box3(new Vector3(-70, -70, -5), new Vector3(70, 70, 60))).getBoundingSphere(ball); nearer = 0.9; }
    const away = Math.max(ball.radius, 3) * nearer / Math.sin((this.camera.fov / 2) * (Math.PI / 180)) / Math.min(1, this.camera.aspect * 1.1);
    this.controls.target.copy(ball.center);
    this.camera.position.copy(ball.center).addScaledVector(new Vector3(0.55, -0.74, at === 'tool' ? 0.3 : 0.42).normalize(), away);
    this.camera.near = Math.max(0.02, away / 400);
    this.camera.far = away * 12 + 2000;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.ask();
  }

  setTheme() {
    this.scene.background = new Color(styleColour('stage') || '#eef1f3');
    this.ask();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement!;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.looking) this.look(this.looking);
    this.ask();
  }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.asked = false;
    this.renderer.render(this.scene, this.camera);
  }
}
