// The picture of a frame: the bird on its track, or a person on their boards.
import { Parts, rgb } from './renderer.js';
import { add, along, axesOf, between, clamp, cross, dot, length, lookAt, mix, multiply, normalized,
         perspective, scale, sub, turned, turnY, turnZ, wrapAngle } from './vector.js';

const LEG_SEGMENT_M = 0.6;  // As footing-view draws it.
const BOARD = { plate_x_m: 0.511, plate_y_m: 0.316 };
const BOARD_HEIGHT_M = 0.053;
const SLAB_M = 0.08;
const FIELD_RAD = 0.8;

const BIRD = { back: rgb(0x5aa6c4), belly: rgb(0xf4ead6), wing: rgb(0x2f7796), tail: rgb(0x3f88a8),
               crest: rgb(0xf06449), skin: rgb(0xf0a04b), beak: rgb(0xf7b538) };
const PERSON = { skin: rgb(0xecc9a4), shirt: rgb(0x3a9aa4), trousers: rgb(0x4a6078),
                 left: rgb(0x3f8fe0), right: rgb(0xf2a33c) };
const REFERENCE = rgb(0x9aa4ae);
const TRACK = rgb(0xc0694a), STRIPE = rgb(0xf2efe6), PLATE = rgb(0xdfe4e8), TOUCH = rgb(0x4fc38a);
const LEVEL = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const array = ({ x, y, z }) => [x, y, z];

const SKIES = {
  light: { fog: rgb(0xc4d6e2), ground: rgb(0x86a86e), line: rgb(0x6f9259) },
  dark: { fog: rgb(0x131a21), ground: rgb(0x26332b), line: rgb(0x3a4a3f) },
};

// The knee of a leg of two equal segments, behind the line from hip to foot.
function kneeOf(hip, foot, forward) {
  const line = sub(foot, hip), long = length(line), way = normalized(line, [0, 0, -1]);
  const across = normalized(sub(forward, scale(way, dot(forward, way))));
  const behind = Math.sqrt(Math.max(0, LEG_SEGMENT_M ** 2 - long * long / 4));
  return sub(add(hip, scale(way, long / 2)), scale(across, behind));
}

function addBirdLeg(parts, hip, foot, forward, floor) {
  const knee = kneeOf(hip, foot, forward), hock = mix(hip, knee, 0.72), calf = mix(hip, knee, 0.3);
  parts.limb(hip, calf, 0.118, 0.098, BIRD.tail);
  parts.limb(calf, hock, 0.098, 0.04, BIRD.tail);
  parts.limb(hock, knee, 0.034, 0.036, BIRD.skin);
  parts.limb(knee, foot, 0.034, 0.024, BIRD.skin);
  const level = normalized([forward[0], forward[1], 0]);
  const toe = (angle, size) => {
    const tip = add(foot, scale(along(turnZ(angle), level), size));
    parts.limb(foot, [tip[0], tip[1], Math.max(floor + 0.012, foot[2] - 0.05)], 0.021, 0.009, BIRD.skin);
  };
  for (const angle of [-0.5, 0, 0.5]) toe(angle, 0.17);
  toe(Math.PI, 0.09);
}

function addBirdHead(parts, axes, place) {
  const forward = normalized([axes[0][0], axes[0][1], 0]), yaw = Math.atan2(forward[1], forward[0]);
  const head = add(place, add(scale(forward, 0.4), [0, 0, 0.6])), turn = turnZ(yaw);
  const at = (x, y, z) => add(head, along(turn, [x, y, z]));
  const base = add(place, along(axes, [0.2, 0, 0.13]));
  const bend = add(base, add(scale(axes[0], 0.22), [0, 0, 0.04])), nape = at(-0.07, 0, -0.24);
  let before = base, radius = 0.14;
  for (let piece = 1; piece <= 8; ++piece) {
    const t = piece / 8, s = 1 - t, next = 0.056 + 0.084 * s * s;
    const point = add(add(scale(base, s * s * s), scale(bend, 3 * s * s * t)),
                      add(scale(nape, 3 * s * t * t), scale(head, t * t * t)));
    parts.limb(before, point, radius, next, BIRD.back);
    [before, radius] = [point, next];
  }
  parts.ball(head, turn, [0.11, 0.098, 0.098], BIRD.back);
  for (const side of [1, -1]) {
    parts.ball(at(0.044, side * 0.064, 0.034), turn, [0.038, 0.038, 0.038], rgb(0xffffff));
    parts.ball(at(0.056, side * 0.081, 0.037), turn, [0.024, 0.024, 0.024], rgb(0x16130f));
  }
  parts.limb(at(0.07, 0, 0), at(0.215, 0, -0.026), 0.042, 0.006, BIRD.beak);
  for (let plume = 0; plume < 3; ++plume) {
    parts.limb(at(0.01 - 0.035 * plume, 0, 0.085), at(-0.07 - 0.08 * plume, 0, 0.18 - 0.035 * plume),
               0.022, 0.01, BIRD.crest);
  }
}

function addBird(parts, skeleton, links, contacts, floor) {
  const index = name => skeleton.links.findIndex(one => one.name === name);
  const contact = name => skeleton.contact_points.indexOf(name);
  const body = links[index('body')];
  const hips = ['left_hip', 'right_hip'].map(name => links[index(name)]);
  const feet = ['left_foot', 'right_foot'].map(name => contacts[contact(name)]);
  if (!body || hips.includes(undefined) || feet.includes(undefined)) return false;
  const place = array(body.position_m), axes = axesOf(body.orientation);
  const up = turned(axes, turnY(-0.1));
  const at = p => add(place, along(axes, p));
  parts.ball(at([0, 0, 0.07]), up, [0.34, 0.215, 0.225], BIRD.back);
  parts.ball(at([-0.16, 0, 0.1]), up, [0.27, 0.175, 0.165], BIRD.back);
  parts.ball(at([0.04, 0, 0.005]), up, [0.29, 0.19, 0.19], BIRD.belly);
  for (let feather = -2; feather <= 2; ++feather) {
    const turn = turned(axes, turned(turnZ(-0.24 * feather), turnY(0.5)));
    parts.ball(add(at([-0.35, 0, 0.15]), along(turn, [-0.16, 0, 0])), turn, [0.19, 0.055, 0.022], BIRD.tail);
  }
  for (const side of [1, -1]) {
    for (let row = 0; row < 3; ++row) {
      const turn = turned(axes, turned(turnZ(side * (0.16 - 0.05 * row)), turnY(-0.2 + 0.1 * row)));
      const middle = add(at([0.13, side * 0.178, 0.19]), along(turn, [-0.17 - 0.02 * row,
        side * (0.03 - 0.006 * row), -0.055 - 0.045 * row]));
      parts.ball(middle, turn, [0.25 - 0.045 * row, 0.032 - 0.005 * row, 0.1], row === 1 ? BIRD.tail : BIRD.wing);
    }
  }
  addBirdHead(parts, axes, place);
  hips.forEach((hip, leg) => addBirdLeg(parts, array(hip.position_m), array(feet[leg].position_m),
                                        axesOf(hip.orientation)[0], floor));
  return true;
}

// Clothes by the name of a link.
function colourOf(name) {
  if (/head|vertex|hand|wrist|finger|thumb/i.test(name)) return PERSON.skin;
  if (/foot|toe|ankle/i.test(name)) return /^(l|left)|_l$/i.test(name) ? PERSON.left : PERSON.right;
  if (/hip|leg|femur|tibia|knee|thigh|shin/i.test(name)) return PERSON.trousers;
  return PERSON.shirt;
}

// Limbs along the links of any tree.
function addTree(parts, names, parents, radii, places, plain) {
  places.forEach((place, i) => {
    const parent = parents[i];
    if (!(parent >= 0 && parent < i)) return;
    const from = places[parent], thick = radii[i] > 0 ? radii[i] : 0.03;
    const colour = plain ?? colourOf(names[parent]);
    if (/head|vertex|headtop/i.test(names[i]) && /end|vertex|top/i.test(names[i])) {
      const middle = mix(from, place, 0.45), up = normalized(sub(place, from), [0, 0, 1]);
      const x = normalized(cross([0, 1, 0], up));
      return parts.ball(middle, [x, cross(up, x), up], [0.095, 0.08, 0.115], colour);
    }
    parts.limb(from, place, clamp(thick, 0.022, 0.09), clamp(0.85 * thick, 0.02, 0.085), colour);
  });
}

function addBoards(parts, layout) {
  for (const side of ['left', 'right']) {
    const pose = layout?.[side] ?? { x_m: 0, y_m: side === 'left' ? 0.168 : -0.168, yaw_rad: 0 };
    const plate = layout?.[side + '_geometry'] ?? BOARD;
    parts.box([pose.x_m, pose.y_m, -BOARD_HEIGHT_M / 2], turnZ(pose.yaw_rad),
              [plate.plate_x_m, plate.plate_y_m, BOARD_HEIGHT_M], PLATE);
  }
}

// Static until the track changes.
export function addTrack(parts, track) {
  for (const segment of track?.segments ?? []) {
    if (segment.pit) continue;
    const axes = turned(turnZ(segment.heading_rad), turnY(-segment.slope_rad));
    const start = array(segment.start_m), sides = [segment.length_m, segment.width_m, SLAB_M];
    const at = (x, y, z) => add(start, along(axes, [x, y, z]));
    parts.box(at(segment.length_m / 2, 0, -SLAB_M / 2), axes, sides, TRACK);
    for (const side of [1, -1]) {
      parts.box(at(segment.length_m / 2, side * (segment.width_m / 2 - 0.04), 0.003), axes,
                [segment.length_m, 0.05, 0.003], STRIPE);
    }
    parts.box(at(0.02, 0, 0.003), axes, [0.03, segment.width_m, 0.003], STRIPE);
  }
}

// Height of the track under a point; undefined where there is none.
function trackHeight(track, [x, y]) {
  for (const segment of track?.segments ?? []) {
    const dx = x - segment.start_m.x, dy = y - segment.start_m.y;
    const ahead = dx * Math.cos(segment.heading_rad) + dy * Math.sin(segment.heading_rad);
    const side = dy * Math.cos(segment.heading_rad) - dx * Math.sin(segment.heading_rad);
    if (ahead >= 0 && ahead <= segment.length_m && Math.abs(side) <= segment.width_m / 2)
      return segment.start_m.z + ahead * Math.tan(segment.slope_rad);
  }
  return undefined;
}

// The characters between two frames, as far along as `share`.
export function interpolate(before, after, share) {
  return after.characters.map(now => {
    const then = before.characters.find(one => one.character === now.character);
    const jumped = !then || then.links.length !== now.links.length ||
        length(sub(array(now.com_m), array(then.com_m))) > 0.5;
    if (jumped) return now;
    const links = now.links.map((link, i) => ({
      position_m: point(then.links[i].position_m, link.position_m, share),
      orientation: between(then.links[i].orientation, link.orientation, share),
    }));
    const contacts = now.contacts.map((one, i) => then.contacts[i]?.position_m && one.position_m
        ? changed(one, { position_m: point(then.contacts[i].position_m, one.position_m, share) }) : one);
    return changed(now, { links, contacts, com_m: point(then.com_m, now.com_m, share) });
  });
}

// A copy of a message with other values of some fields; it keeps the defaults of the others.
function changed(message, fields) {
  return Object.assign(Object.create(Object.getPrototypeOf(message)), message, fields);
}

function point(a, b, share) {
  return { x: a.x + share * (b.x - a.x), y: a.y + share * (b.y - a.y), z: a.z + share * (b.z - a.z) };
}

// The person's own view: turned by a drag, nearer by a pinch or the wheel.
export class Orbit {
  constructor() { this.reset(); }
  reset() { Object.assign(this, { azimuth: 0, elevation: 0, distance: 1 }); }
  turn(azimuth, elevation) {
    this.azimuth = wrapAngle(this.azimuth + azimuth);
    this.elevation = clamp(this.elevation + elevation, -0.3, 1.1);
  }
  zoom(factor) { this.distance = clamp(this.distance * factor, 0.35, 4); }
}

export class Scene {
  constructor() {
    this.figures = new Parts();
    this.fixed = new Parts();
    this.orbit = new Orbit();
    this.skeletons = new Map();
    this.camera = null;
    this.drawn = 0;
  }

  // Retained by the server: `skeletons` and `track` of a tick, `layout` of the rig's boards.
  take({ skeletons, track, layout }) {
    if (skeletons) this.skeletons = new Map(skeletons.skeletons.map(one => [one.character, one]));
    if (track) this.track = track;
    if (layout) this.layout = layout;
    this.fixed.clear();
    addTrack(this.fixed, this.track);
  }

  // A picture of the characters, `dt_s` after the one before; `reference` may be undefined.
  draw(renderer, characters, reference, dt_s, dark) {
    renderer.resize(dt_s);
    const first = characters[0], isPerson = Boolean(first?.body);
    this.figures.clear();
    const com = first ? array(first.com_m) : [0, 0, 1];
    const ground = isPerson ? -BOARD_HEIGHT_M : (this.track?.segments[0]?.start_m.z ?? 0) - SLAB_M;
    const shadow = isPerson ? 0 : trackHeight(this.track, com) ?? ground;
    for (const one of characters) this.addCharacter(one, shadow);
    if (isPerson) addBoards(this.figures, this.layout);
    if (reference) this.addReference(reference);
    const { eye, target } = this.look(first, com, isPerson, dt_s);
    const aspect = renderer.canvas.width / renderer.canvas.height;
    const field = aspect < 0.9 ? Math.min(1.25, FIELD_RAD * 0.9 / aspect) : FIELD_RAD;
    const toClip = multiply(perspective(field, aspect, 0.1, 300), lookAt(eye, target));
    renderer.draw(toClip, eye, this.figures, this.fixed,
                  { middle: [Math.round(com[0]), Math.round(com[1])], height: ground, shadow: isPerson ? ground : shadow },
                  dark ? SKIES.dark : SKIES.light);
    ++this.drawn;
  }

  addCharacter(character, floor) {
    const skeleton = this.skeletons.get(character.character);
    if (!skeleton || !character.valid || character.links.length !== skeleton.links.length) return;
    if (!character.body && addBird(this.figures, skeleton, character.links, character.contacts, floor)) return;
    const radii = skeleton.links.map(({ size_m }) => size_m ? 0.5 * Math.max(size_m.x, size_m.y, size_m.z) : 0);
    addTree(this.figures, skeleton.links.map(one => one.name), skeleton.links.map(one => one.parent), radii,
            character.links.map(one => array(one.position_m)));
    for (const foot of character.body?.feet ?? []) {
      if (!foot.cop_valid || !foot.cop_m) continue;
      const radius = 0.02 + 0.04 * clamp(foot.load_n / 800, 0, 1);
      this.figures.ball(array(foot.cop_m), LEVEL, [radius, radius, 0.006], TOUCH);
    }
  }

  // The true pose of a simulated person, beside the reconstructed one.
  addReference(pose) {
    const places = pose.positions_m.map(p => add(array(p), [-0.75, -1.3, -BOARD_HEIGHT_M]));
    addTree(this.figures, places.map(() => ''), pose.parents, places.map(() => 0.05), places, REFERENCE);
  }

  // Follows the character from behind, or stands before a person.
  look(character, com, isPerson, dt_s) {
    const heading = isPerson ? Math.PI : character?.gait?.heading_rad ?? 0;
    const goal = isPerson ? [com[0], com[1], 0.95] : [com[0], com[1], com[2] + 0.05];
    const share = 1 - Math.exp(-dt_s / 0.25), then = this.camera;
    this.camera = !then || length(sub(then.target, goal)) > 2 ? { target: goal, heading } : {
      target: mix(then.target, goal, isPerson ? 0.3 * share : 1 - Math.exp(-dt_s / 0.08)),
      heading: then.heading + 0.5 * share * wrapAngle(heading - then.heading),
    };
    const { target } = this.camera, azimuth = this.camera.heading + this.orbit.azimuth + (isPerson ? 0.35 : 0.3);
    const elevation = clamp((isPerson ? 0.14 : 0.26) + this.orbit.elevation, 0.02, 1.4);
    const away = (isPerson ? 3.6 : 4.6) * this.orbit.distance;
    const back = [-Math.cos(azimuth) * Math.cos(elevation), -Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation)];
    return { eye: add(target, scale(back, away)), target };
  }
}
