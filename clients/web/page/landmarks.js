// From the landmarks of a pose model to the joints of a skeleton in the camera's frame, and to the
// message that footing-skeleton takes (docs/skeleton.md, "footing").

// Of the model's 33 landmarks; a hand is made of wrist and knuckles.
const SIDES = { left: 0, right: 1 };
const EAR = 7, SHOULDER = 11, ELBOW = 13, WRIST = 15, PINKY = 17, INDEX = 19, HIP = 23, KNEE = 25,
      ANKLE = 27;
const PLAIN = { ear: EAR, shoulder: SHOULDER, elbow: ELBOW, hip: HIP, knee: KNEE, ankle: ANKLE };
const FIST_SHARE = 0.6;  // Of the way from the wrist to the knuckles.
const LEAST_VISIBILITY = 0.5;  // Of landmarks that place the person.

function mix(a, b, share) {
  const of = key => a[key] + share * (b[key] - a[key]);
  return { x: of('x'), y: of('y'), z: of('z'),
           visibility: Math.min(a.visibility ?? 0, b.visibility ?? 0) };
}

// Solves the symmetric 3 by 3 system A t = b; null where it does not determine t.
function solve3(A, b) {
  const [[a, d, e], [, f, g], [, , h]] = A;
  const cofactors = [[f * h - g * g, e * g - d * h, d * g - e * f],
                     [e * g - d * h, a * h - e * e, d * e - a * g],
                     [d * g - e * f, d * e - a * g, a * f - d * d]];
  const determinant = a * cofactors[0][0] + d * cofactors[0][1] + e * cofactors[0][2];
  if (!(Math.abs(determinant) > 1e-12)) return null;
  return cofactors.map(row => (row[0] * b[0] + row[1] * b[1] + row[2] * b[2]) / determinant);
}

// Where the middle of the hips is from the camera (x right, y down, z away, m): the model gives
// places about the hips in metres and where they are in the image; both agree for one place only.
// image: x, y from 0 to 1. Linear least squares of f (X + tx) = u (Z + tz), f (Y + ty) = v (Z + tz).
export function placeOfHips(image, world, width, height, fieldOfViewDeg) {
  const f = 0.5 * width / Math.tan(0.5 * fieldOfViewDeg * Math.PI / 180);
  const A = [[0, 0, 0], [0, 0, 0], [0, 0, 0]], b = [0, 0, 0];
  const add = (row, value, weight) => {
    for (let i = 0; i < 3; ++i) {
      for (let j = 0; j < 3; ++j) A[i][j] += weight * row[i] * row[j];
      b[i] += weight * row[i] * value;
    }
  };
  for (const index of [SHOULDER, SHOULDER + 1, ELBOW, ELBOW + 1, HIP, HIP + 1, KNEE, KNEE + 1,
                       ANKLE, ANKLE + 1]) {
    const weight = world[index].visibility ?? 0;
    if (weight < LEAST_VISIBILITY) continue;
    const u = (image[index].x - 0.5) * width / f, v = (image[index].y - 0.5) * height / f;
    add([1, 0, -u], u * world[index].z - world[index].x, weight);
    add([0, 1, -v], v * world[index].z - world[index].y, weight);
  }
  const place = solve3(A, b);
  return place && place[2] > 0.3 && place[2] < 20 ? place : null;
}

// The joints in the camera's frame: x to the camera's left, y up, z away from it, m. Empty where
// nothing places the person.
export function toJoints(image, world, width, height, fieldOfViewDeg) {
  const hips = placeOfHips(image, world, width, height, fieldOfViewDeg);
  if (!hips) return [];
  const joints = [];
  const add = (name, point) => joints.push({
    name, x: -(point.x + hips[0]), y: -(point.y + hips[1]), z: point.z + hips[2],
    confidence: Math.max(0, Math.min(1, point.visibility ?? 0)) });
  for (const [side, offset] of Object.entries(SIDES)) {
    for (const [name, index] of Object.entries(PLAIN)) add(side + '_' + name, world[index + offset]);
    const knuckles = mix(world[INDEX + offset], world[PINKY + offset], 0.5);
    add(side + '_hand', mix(world[WRIST + offset], knuckles, FIST_SHARE));
  }
  return joints;
}

class Writer {
  constructor() { this.bytes = []; }
  string(text) {
    for (const c of text) this.bytes.push(c.charCodeAt(0));
    do this.bytes.push(0); while (this.bytes.length % 4 !== 0);
  }
  number(size, set) {
    const view = new DataView(new ArrayBuffer(size));
    set(view);
    this.bytes.push(...new Uint8Array(view.buffer));
  }
  int32(value) { this.number(4, view => view.setInt32(0, value)); }
  int64(value) { this.number(8, view => view.setBigInt64(0, BigInt(value))); }
  float32(value) { this.number(4, view => view.setFloat32(0, value)); }
  element(write) {
    const inner = new Writer();
    write(inner);
    this.int32(inner.bytes.length);
    for (const byte of inner.bytes) this.bytes.push(byte);
  }
}

const NTP_TO_UNIX_S = 2208988800;

// One person and exposure in Footing's dialect. unixMs: of the exposure.
export function encode(joints, user, sequence, unixMs) {
  const writer = new Writer();
  writer.string('#bundle');
  const seconds = Math.floor(unixMs / 1000);
  writer.number(8, view => {
    view.setUint32(0, seconds + NTP_TO_UNIX_S);
    view.setUint32(4, Math.floor((unixMs / 1000 - seconds) * 4294967296));
  });
  writer.element(message => {
    message.string('/footing/skeleton');
    message.string(',hi');
    message.int64(sequence);
    message.int32(user);
  });
  for (const joint of joints) {
    writer.element(message => {
      message.string('/footing/joint');
      message.string(',sffff');
      message.string(joint.name);
      for (const value of [joint.x, joint.y, joint.z, joint.confidence]) message.float32(value);
    });
  }
  return new Uint8Array(writer.bytes);
}

// A person of 1.75 m who stands 2.5 m before a camera 1 m up and waves the left hand, as the model
// would report: landmarks of the image and about the hips.
export function syntheticLandmarks(timeS, width, height, fieldOfViewDeg) {
  const wave = 0.15 * Math.sin(2 * Math.PI * 0.5 * timeS);
  const left = { [EAR]: [0.08, -0.68, 0], [SHOULDER]: [0.18, -0.5, 0], [ELBOW]: [0.46, -0.5, 0],
                 [WRIST]: [0.70, -0.5 - wave, 0], [PINKY]: [0.79, -0.49 - wave, 0],
                 [INDEX]: [0.79, -0.51 - wave, 0], [HIP]: [0.09, 0, 0], [KNEE]: [0.1, 0.42, 0],
                 [ANKLE]: [0.1, 0.83, 0] };
  const world = [], image = [];
  const hips = [0, 0.09, 2.5], f = 0.5 * width / Math.tan(0.5 * fieldOfViewDeg * Math.PI / 180);
  for (let i = 0; i < 33; ++i) {
    const side = i >= 7 && i % 2 === 0 ? -1 : 1;
    const [x, y, z] = left[side === 1 ? i : i - 1] ?? [0, -0.6, -0.1];
    const visibility = left[side === 1 ? i : i - 1] ? 0.99 : 0;
    world.push({ x: side * x, y, z, visibility });
    const away = z + hips[2];
    image.push({ x: 0.5 + f * (side * x + hips[0]) / away / width,
                 y: 0.5 + f * (y + hips[1]) / away / height, z: 0, visibility });
  }
  return { image, world };
}
