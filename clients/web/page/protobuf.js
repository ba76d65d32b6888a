// Protobuf in a few lines: reads and writes messages by the table of schema.js.
//
// A message becomes an object with every field by its name in proto/footing/v1. A field that is not
// there has its default: 0, false, '', an empty array, or undefined for a message. Instants (fields
// whose names end in _ns) become numbers; other integers of 64 bits become BigInt, since the epoch
// needs all its digits.
import { MESSAGES } from './schema.js';

const VARINT = 0, FIXED64 = 1, BYTES = 2, FIXED32 = 5;
const WIRE = { d: FIXED64, f: FIXED32, s: BYTES, y: BYTES };
const DEFAULTS = { d: 0, f: 0, u: 0n, l: 0n, n: 0, w: 0, i: 0, z: 0, b: false, s: '' };
const MOST_DEPTH = 32;

const text = new TextDecoder();
const utf8 = new TextEncoder();

// Kind to an object with the defaults of its fields, which its messages inherit.
const prototypes = new Map();

function prototypeOf(kind) {
  let made = prototypes.get(kind);
  if (made) return made;
  made = {};
  for (const [name, type, repeated] of Object.values(MESSAGES[kind])) {
    made[name] = repeated ? Object.freeze([]) : type === 'y' ? new Uint8Array() : DEFAULTS[type];
  }
  prototypes.set(kind, made);
  return made;
}

class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.at = 0;
  }

  // The low and the high 32 bits of a varint, into this.low and this.high.
  varint() {
    let low = 0, high = 0;
    for (let shift = 0; shift < 70; shift += 7) {
      const byte = this.bytes[this.at++];
      if (byte === undefined) throw new RangeError('a message ends within a number');
      const bits = byte & 0x7f;
      if (shift < 28) low |= bits << shift;
      else if (shift === 28) { low |= bits << 28; high |= bits >> 4; }
      else high |= shift < 63 ? bits << (shift - 32) : (bits & 1) << 31;
      if (byte < 0x80) {
        this.low = low >>> 0;
        this.high = high >>> 0;
        return;
      }
    }
    throw new RangeError('a number has more than ten bytes');
  }

  uint32() {
    this.varint();
    return this.low;
  }

  chunk() {
    const size = this.uint32(), from = this.at;
    if (from + size > this.bytes.length) throw new RangeError('a message ends within a field');
    this.at += size;
    return this.bytes.subarray(from, this.at);
  }

  fixed(size) {
    const from = this.at;
    if (from + size > this.bytes.length) throw new RangeError('a message ends within a number');
    this.at += size;
    return from;
  }

  skip(wire) {
    if (wire === VARINT) this.varint();
    else if (wire === FIXED64) this.fixed(8);
    else if (wire === FIXED32) this.fixed(4);
    else if (wire === BYTES) this.chunk();
    else throw new RangeError('a field has an unknown form');
  }

  value(type, depth) {
    switch (type) {
      case 'd': return this.view.getFloat64(this.fixed(8), true);
      case 'f': return this.view.getFloat32(this.fixed(4), true);
      case 's': return text.decode(this.chunk());
      case 'y': return this.chunk();
      case 'w': return this.uint32();
      case 'i': return this.uint32() | 0;
      case 'b': this.varint(); return (this.low | this.high) !== 0;
      case 'z': this.varint(); return (this.low >>> 1) ^ -(this.low & 1);
      case 'n': this.varint(); return (this.high | 0) * 4294967296 + this.low;
      case 'u': this.varint(); return (BigInt(this.high) << 32n) | BigInt(this.low);
      case 'l': this.varint(); return BigInt.asIntN(64, (BigInt(this.high) << 32n) | BigInt(this.low));
      default: return decodeAt(type, this.chunk(), depth + 1);
    }
  }
}

function decodeAt(kind, bytes, depth) {
  if (depth > MOST_DEPTH) throw new RangeError('a message is nested too deeply');
  const fields = MESSAGES[kind], message = Object.create(prototypeOf(kind));
  const reader = new Reader(bytes);
  while (reader.at < bytes.length) {
    const tag = reader.uint32(), wire = tag & 7, field = fields[tag >>> 3];
    if (!field) { reader.skip(wire); continue; }
    const [name, type, repeated] = field;
    const own = type.length > 1 ? BYTES : WIRE[type] ?? VARINT;
    if (repeated && !Object.hasOwn(message, name)) message[name] = [];
    if (repeated && wire === BYTES && own !== BYTES) {
      const packed = new Reader(reader.chunk());
      while (packed.at < packed.bytes.length) message[name].push(packed.value(type, depth));
    } else if (wire !== own) {
      reader.skip(wire);
    } else if (repeated) {
      message[name].push(reader.value(type, depth));
    } else {
      message[name] = reader.value(type, depth);
    }
  }
  return message;
}

// The message of that kind in a Uint8Array; throws a RangeError for what is none.
export function decode(kind, bytes) {
  return decodeAt(kind, bytes, 0);
}

function writeVarint(out, value) {
  let rest = BigInt.asUintN(64, BigInt(value));
  while (rest >= 0x80n) {
    out.push(Number(rest & 0x7fn) | 0x80);
    rest >>= 7n;
  }
  out.push(Number(rest));
}

function writeBytes(out, bytes) {
  writeVarint(out, bytes.length);
  for (const byte of bytes) out.push(byte);
}

function writeValue(out, type, value) {
  if (type === 'd' || type === 'f') {
    const view = new DataView(new ArrayBuffer(type === 'd' ? 8 : 4));
    if (type === 'd') view.setFloat64(0, value, true);
    else view.setFloat32(0, value, true);
    for (let i = 0; i < view.byteLength; ++i) out.push(view.getUint8(i));
  } else if (type === 's') writeBytes(out, utf8.encode(value));
  else if (type === 'y') writeBytes(out, value);
  else if (type === 'z') writeVarint(out, value < 0 ? -2 * value - 1 : 2 * value);
  else if (type.length > 1) writeBytes(out, encode(type, value));
  else writeVarint(out, type === 'n' ? Math.round(value) : value);
}

// The bytes of an object with the fields of that kind; those that it lacks are absent.
export function encode(kind, message) {
  const out = [];
  for (const [number, [name, type, repeated]] of Object.entries(MESSAGES[kind])) {
    if (!Object.hasOwn(message, name) || message[name] === undefined) continue;
    const value = message[name];
    const wire = type.length > 1 ? BYTES : WIRE[type] ?? VARINT;
    for (const one of repeated ? value : [value]) {
      writeVarint(out, Number(number) * 8 + wire);
      writeValue(out, type, one);
    }
  }
  return Uint8Array.from(out);
}
