// The machine's bodies as three.js objects, posed for any instant.
import {
  BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, Color, CylinderGeometry, Group, Matrix4, Mesh, MeshLambertMaterial, Object3D,
  Quaternion, SphereGeometry, Vector3,
} from 'three';
import { lastNotAbove, unpackColumn, unpackIntegers, unpackPoses, type Poses } from './pack';
import type { Body, Form, MeshData, PoseData, ReplayData } from './record';

const kRound = 24;  // sides of round bodies

export function meshGeometry(data: MeshData): BufferGeometry {
  const [x, y, z] = [data.x_mm, data.y_mm, data.z_mm].map(unpackColumn);
  const position = new Float32Array(3 * x.length);
  for (let i = 0; i < x.length; ++i) position.set([x[i], y[i], z[i]], 3 * i);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(position, 3));
  geometry.setIndex(new BufferAttribute(Uint32Array.from(unpackIntegers(data.corners)), 1));
  geometry.computeVertexNormals();
  return geometry;
}

/** Round forms of three.js stand along y, ours along z. */
export function formGeometry(form: Form): BufferGeometry {
  if (form.sphere_mm) return new SphereGeometry(form.sphere_mm[0], kRound, kRound / 2);
  if (form.capsule_mm) return new CapsuleGeometry(form.capsule_mm[0], form.capsule_mm[1], 6, kRound).rotateX(Math.PI / 2);
  if (form.cylinder_mm) return new CylinderGeometry(form.cylinder_mm[0], form.cylinder_mm[0], form.cylinder_mm[1], kRound).rotateX(Math.PI / 2);
  if (form.frustum_mm) {
    const [bottom, top, height] = form.frustum_mm;
    return new CylinderGeometry(top, bottom, height, kRound).rotateX(Math.PI / 2).translate(0, 0, height / 2);
  }
  if (form.box_mm) {
    const at = form.at_mm || [0, 0, 0];
    return new BoxGeometry(...(form.box_mm as [number, number, number])).translate(at[0], at[1], at[2]);
  }
  return form.mesh ? meshGeometry(form.mesh) : new BufferGeometry();
}

export function pose(object: Object3D, data: PoseData) {
  object.position.fromArray(data.place_mm);
  object.quaternion.set(data.turn[1], data.turn[2], data.turn[3], data.turn[0]).normalize();
}

/** Between the instants of `times`: places linearly, turns along the shorter arc. */
export function poseAt(poses: Poses, times: ArrayLike<number>, time: number, place: Vector3, turn: Quaternion) {
  const i = lastNotAbove(times, time), j = Math.min(i + 1, poses.count - 1);
  const span = times[j] - times[i], share = span > 0 ? Math.min(1, Math.max(0, (time - times[i]) / span)) : 0;
  place.fromArray(poses.place, 3 * i).lerp(new Vector3().fromArray(poses.place, 3 * j), share);
  turn.fromArray(poses.turn, 4 * i).slerp(new Quaternion().fromArray(poses.turn, 4 * j), share).normalize();
}

const kColours: [RegExp, number][] = [[/nozzle|tip|mill/, 0xc79a3b], [/heater/, 0x8c4a44], [/strut|rod/, 0x4a6f9c], [/base frame/, 0x9aa3ab]];

function colourOf(name: string): Color {
  const found = kColours.find(([words]) => words.test(name));
  return new Color(found ? found[1] : 0x9098a1);
}

interface Strut { rod: Mesh; ends: Mesh[]; from: Vector3; to: Vector3 }

export class Machine {
  readonly root = new Group();
  readonly tool = new Group();
  readonly left: string[] = [];  // what is drawn as less than it is
  private readonly keys: Float64Array;
  private readonly struts: Strut[] = [];
  private readonly carried: { object: Object3D; poses: Poses }[] = [];
  private readonly materials: MeshLambertMaterial[] = [];
  private readonly frame: Poses | null;

  constructor(data: ReplayData) {
    this.keys = unpackColumn(data.key_time_s);
    this.frame = data.machine_frame ? unpackPoses(data.machine_frame) : null;
    this.root.add(this.tool);
    for (const body of data.bodies) this.add(body);
  }

  private add(body: Body) {
    const material = new MeshLambertMaterial({ color: colourOf(body.name) });
    this.materials.push(material);
    if (body.form.box_for_triangles) this.left.push(body.name + ' is drawn as a box: it has ' + body.form.box_for_triangles + ' triangles');
    if (body.carrier === 'strut') { this.addStrut(body, material); return; }
    const object = new Mesh(formGeometry(body.form), material);
    if (body.pose) pose(object, body.pose);
    if (body.carrier === 'axes' && body.poses) this.carried.push({ object, poses: unpackPoses(body.poses) });
    (body.carrier === 'tool' ? this.tool : this.root).add(object);
  }

  private addStrut(body: Body, material: MeshLambertMaterial) {
    const radius = body.form.capsule_mm![0];
    const rod = new Mesh(new CylinderGeometry(radius, radius, 1, kRound).rotateX(Math.PI / 2), material);
    const ends = [0, 1].map(() => new Mesh(new SphereGeometry(radius, kRound, kRound / 2), material));
    this.root.add(rod, ...ends);
    this.struts.push({ rod, ends, from: new Vector3().fromArray(body.from_mm!), to: new Vector3().fromArray(body.to_tool_mm!) });
  }

  /** The tool stands where the run says. */
  show(time: number, place: Vector3, turn: Quaternion) {
    this.tool.position.copy(place);
    this.tool.quaternion.copy(turn);
    for (const { object, poses } of this.carried) poseAt(poses, this.keys, time, object.position, object.quaternion);
    const end = new Vector3(), axis = new Vector3();
    for (const strut of this.struts) {
      end.copy(strut.to).applyQuaternion(turn).add(place);
      axis.subVectors(end, strut.from);
      strut.rod.position.addVectors(strut.from, end).multiplyScalar(0.5);
      strut.rod.scale.z = axis.length();
      strut.rod.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), axis.normalize());
      strut.ends[0].position.copy(strut.from);
      strut.ends[1].position.copy(end);
    }
  }

  /** Of the world in the machine's frame: where axes move the table, the machine stands level and the table is tilted. */
  level(time: number): Matrix4 {
    const matrix = new Matrix4();
    if (!this.frame) return matrix;
    const place = new Vector3(), turn = new Quaternion();
    poseAt(this.frame, this.keys, time, place, turn);
    return matrix.compose(place, turn, new Vector3(1, 1, 1)).invert();
  }

  setLook(look: string) {
    this.root.visible = look !== 'hidden';
    for (const material of this.materials) {
      material.transparent = look === 'see-through';
      material.opacity = look === 'see-through' ? 0.22 : 1;
      material.depthWrite = look !== 'see-through';
      material.needsUpdate = true;
    }
  }
}
