// A phone's motion sensor as the report of an inertial sensor (docs/devices.md).

export const MOST_SAMPLES = 20;
const HEAD_BYTES = 15, SAMPLE_BYTES = 28;
const INVERTED = 1, HAS_RATE = 2, DEGREES = 4;
const INPUT = 1;

// The bytes of a report. samples: {us: time of the sensor's own clock, acceleration: [x, y, z] as
// the browser gives it, m/s², rate: [x, y, z], degrees a second, or null}, oldest first.
export function reportOf(samples, number, { inverted, battery }) {
  const view = new DataView(new ArrayBuffer(HEAD_BYTES + SAMPLE_BYTES * samples.length));
  const newest = samples.at(-1).us, hasRate = samples.every(one => one.rate);
  view.setUint8(0, INPUT);
  view.setUint8(1, (inverted ? INVERTED : 0) | (hasRate ? HAS_RATE : 0) | DEGREES);
  view.setUint8(2, 0);
  view.setUint8(3, battery ?? 255);
  view.setUint16(4, number & 0xffff, true);
  view.setBigUint64(6, BigInt(newest), true);
  view.setUint8(14, samples.length);
  samples.forEach((sample, i) => {
    const at = HEAD_BYTES + SAMPLE_BYTES * i;
    view.setUint32(at, newest - sample.us, true);
    for (let axis = 0; axis < 3; ++axis) {
      view.setFloat32(at + 4 + 4 * axis, sample.acceleration[axis], true);
      view.setFloat32(at + 16 + 4 * axis, sample.rate?.[axis] ?? 0, true);
    }
  });
  return new Uint8Array(view.buffer);
}

// By the specification a phone that lies face up has +9.8 along z; on iOS it has -9.8, and all of
// its accelerations are inverted. Which one holds shows when the way up that the orientation says
// is compared with the acceleration of a phone that hardly moves.
export class SignFinder {
  // `inverted`: the guess until then.
  constructor(inverted) {
    this.inverted = inverted;
    this.known = false;
    this.sum = 0;
    this.count = 0;
  }

  // beta, gamma: degrees, as of deviceorientation.
  orient(beta, gamma) {
    if (beta === null || gamma === null) return;
    const b = beta * Math.PI / 180, g = gamma * Math.PI / 180;
    this.up = [-Math.cos(b) * Math.sin(g), Math.sin(b), Math.cos(b) * Math.cos(g)];
  }

  feel([x, y, z]) {
    if (this.known || !this.up || Math.abs(Math.hypot(x, y, z) - 9.8) > 3) return;
    this.sum += x * this.up[0] + y * this.up[1] + z * this.up[2];
    if (++this.count < 15) return;
    this.known = Math.abs(this.sum / this.count) > 3;
    if (this.known) this.inverted = this.sum < 0;
    this.sum = this.count = 0;
  }
}
