// The live page: what footing-sim and footingd publish, as a picture, signals and words.
import { enter } from './entry.js';
import { nameOf, showDevices, showInterface, showNumbers, showStudy, showTrial } from './panels.js';
import { Renderer } from './renderer.js';
import { interpolate, Scene } from './scene.js';
import { Session } from './session.js';
import { Strips } from './strips.js';

const CHANNELS = ['status', 'motion', 'features', 'boards', 'setup', 'reference', 'skeletons', 'track', 'characters', 'study'];
// Ticks a second; half of them where a processor draws.
let maxHz = Number(new URLSearchParams(location.search).get('hz'));
const RECENT_S = 5, PAST_S = 180, PAST_STEP_S = 1 / 15;
const STALE_S = 1, PANELS_EVERY_MS = 200;
const GRAVITY_MPS2 = 9.80665;

const element = id => document.getElementById(id);
const say = (id, text) => { if (element(id).textContent !== text) element(id).textContent = text; };
const dark = window.matchMedia('(prefers-color-scheme: dark)');

// Messages that have come, by the server that sent it.
const state = {
  sessions: [], devices: [], frames: [], past: [], lag: 0, simulation: null, sensor: null,
  reference: null, study: null, studyAt: 0, delay: 0, missed: 0, shownAge: NaN, ticks: 0,
};
const scene = new Scene();
const strips = new Strips(element('strips'));

function takeFrame(session, tick) {
  const time = tick.host_ns * 1e-9, frame = { time, characters: tick.characters.characters };
  const last = state.frames.at(-1);
  if (last && time < last.time) state.frames.length = state.past.length = 0;  // Another start.
  state.frames.push(frame);
  while (state.frames[0].time < time - RECENT_S) state.frames.shift();
  if (!state.past.length || time - state.past.at(-1).time >= PAST_STEP_S) state.past.push(frame);
  while (state.past[0].time < time - PAST_S) state.past.shift();
  const age = session.serverNs() * 1e-9 - time;
  if (age >= 0) state.lag = Math.min(0.2, Math.max(age, 0.99 * state.lag));
}

function takeSamples(tick) {
  const titleOf = number => {
    const device = state.devices.find(one => one.device === number);
    return device ? nameOf(device) : `device ${number}`;
  };
  for (const sample of tick.motion?.samples ?? []) {
    const { x, y, z } = sample.specific_force_mps2;
    strips.push(`motion ${sample.device}`, `${titleOf(sample.device)}, acceleration`, 'm/s²', [0, 2 * GRAVITY_MPS2],
                sample.sampled_ns * 1e-9, Math.hypot(x, y, z));
  }
  for (const sample of tick.boards?.samples ?? []) {
    strips.push(`board ${sample.device}`, `${titleOf(sample.device)}, load`, 'kg', [0, 80],
                sample.sampled_ns * 1e-9, sample.total_n / GRAVITY_MPS2);
  }
}

function takeTick(session, tick) {
  ++state.ticks;
  if (tick.skeletons || tick.track) scene.take(tick);
  if (tick.setup) scene.take({ layout: tick.setup.rigs[0]?.layout });
  if (tick.characters) {
    state.simulation = session;
    takeFrame(session, tick);
  }
  if (tick.status) {
    state.sensor = session;
    state.devices = tick.status.devices;
    showDevices(element('devices'), element('no-devices'), state.devices);
  }
  if (tick.setup) showPrompt(tick.setup.rigs.find(rig => rig.prompt)?.prompt.text ?? '');
  if (tick.study) Object.assign(state, { study: tick.study, studyAt: performance.now() });
  if (tick.reference) state.reference = { pose: tick.reference.poses[0], time: tick.host_ns * 1e-9 };
  takeSamples(tick);
}

function showPrompt(text) {
  say('prompt', text);
  element('prompt').hidden = !text;
}

// The characters at an instant of the server's clock, s, and the time of what that shows.
function framesAt(time) {
  const frames = state.frames.length && time >= state.frames[0].time ? state.frames : state.past;
  if (!frames.length) return null;
  let low = 0, high = frames.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (frames[middle].time > time) high = middle;
    else low = middle + 1;
  }
  if (low === 0) return frames[0];
  const before = frames[low - 1], after = frames[low];
  if (!after) return before;
  const share = (time - before.time) / (after.time - before.time);
  return { time, characters: interpolate(before, after, share) };
}

function shownFrame() {
  const newest = state.frames.at(-1);
  if (!newest) return null;
  const now = state.simulation.serverNs() * 1e-9;
  if (!(now > 0)) return newest;
  const frame = framesAt(now - state.lag - 1 / maxHz - state.delay);
  state.shownAge = now - frame.time;
  return frame;
}

// The state in words: what is wrong and what to do, or that all is well.
function verdict() {
  const live = state.sessions.filter(one => one.state === 'live');
  if (!live.length) {
    const why = state.sessions.find(one => one.shownWhy)?.shownWhy;
    return ['bad', `No server: ${why || 'connecting'}.`];
  }
  if (!state.simulation) return ['warn', 'footing-sim has not answered: start it to see the body.'];
  if (state.simulation.state !== 'live') return ['bad', `footing-sim is gone: ${state.simulation.shownWhy}.`];
  if (state.delay === 0 && state.shownAge > STALE_S) return ['bad', `Stale: what you see is ${state.shownAge.toFixed(0)} s old.`];
  if (!state.sensor) return ['warn', 'footingd has not answered: start it to see the devices.'];
  if (state.sensor.state !== 'live') return ['bad', `footingd is gone: ${state.sensor.shownWhy}.`];
  const attached = state.devices.filter(one => one.state !== 4);
  if (!attached.length) return ['warn', 'No device: switch a controller on, or start scripts/demo.'];
  const quiet = attached.find(one => one.state === 3);
  if (quiet) return ['warn', `${nameOf(quiet)} is silent${quiet.note ? ': ' + quiet.note : ''}.`];
  return ['good', state.delay === 0 ? 'Live.' : 'Not live: you see the past.'];
}

function showPanels() {
  const [kind, text] = verdict();
  say('status', text);
  element('status').className = kind;
  element('notice').hidden = kind !== 'bad';
  say('notice', kind === 'bad' ? text : '');
  const character = state.frames.at(-1)?.characters[0];
  element('simulated').hidden = !(character?.simulated_input || state.devices.some(one => one.simulated && one.state !== 4));
  showInterface(element('gait'), element('activity'), character);
  showNumbers(element('numbers'), character);
  showStudy(element('study-panel'), element('study-title'), element('study-doing'), element('study-list'), state.study,
            (performance.now() - state.studyAt) / 1e3);
  showTrial(element('trial-panel'), element('trial-text'), element('trial'), character?.trial);
  element('picture').setAttribute('aria-label', element('gait').textContent === '-' ? 'No body yet'
      : `The simulated body: ${element('gait').textContent}`);
  showServers();
}

function showServers() {
  const list = element('servers');
  while (list.children.length < state.sessions.length) list.append(document.createElement('li'));
  state.sessions.forEach((session, i) => {
    const age = session === state.simulation && Number.isFinite(state.shownAge) ? `, shown ${Math.round(1e3 * state.shownAge)} ms after it happened` : '';
    const missed = session.missed ? `, ${session.missed} ticks missed` : '';
    const text = `${session.serverName ?? 'server'}: ${session.state}${session.shownWhy ? ' (' + session.shownWhy + ')' : ''}${age}${missed}`;
    if (list.children[i].textContent !== text) list.children[i].textContent = text;
  });
}

function openSessions(count) {
  for (let i = 0; i < count; ++i) {
    const session = new Session({ path: `/session/${i}`, name: 'live page', channels: CHANNELS, maxHz }, {
      onWelcome: welcome => { session.serverName = welcome.server_id; },
      onTick: tick => takeTick(session, tick),
      onGap: missing => { session.missed = (session.missed ?? 0) + missing; },
      onState: () => {},
    });
    state.sessions.push(session);
  }
}

function watchPointer(canvas) {
  const pointers = new Map();
  canvas.addEventListener('pointerdown', event => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, event);
  });
  canvas.addEventListener('pointermove', event => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const others = [...pointers.values()].filter(one => one.pointerId !== event.pointerId);
    const apart = one => Math.hypot(one.clientX - others[0].clientX, one.clientY - others[0].clientY);
    if (others.length) scene.orbit.zoom(apart(before) / Math.max(1, apart(event)));
    else scene.orbit.turn(-0.008 * (event.clientX - before.clientX), 0.006 * (event.clientY - before.clientY));
    pointers.set(event.pointerId, event);
  });
  for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, event => pointers.delete(event.pointerId));
  canvas.addEventListener('dblclick', () => scene.orbit.reset());
  canvas.addEventListener('wheel', event => {
    event.preventDefault();
    scene.orbit.zoom(Math.exp(0.001 * event.deltaY));
  }, { passive: false });
  const keys = { ArrowLeft: () => scene.orbit.turn(0.1, 0), ArrowRight: () => scene.orbit.turn(-0.1, 0),
                 ArrowUp: () => scene.orbit.turn(0, 0.08), ArrowDown: () => scene.orbit.turn(0, -0.08),
                 '+': () => scene.orbit.zoom(0.9), '-': () => scene.orbit.zoom(1.1), r: () => scene.orbit.reset() };
  canvas.addEventListener('keydown', event => {
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  });
}

function watchControls() {
  const toggleFull = () => document.fullscreenElement ? document.exitFullscreen() : element('view').requestFullscreen();
  element('full-screen').onclick = toggleFull;
  addEventListener('keydown', event => { if (event.key === 'f' && event.target !== element('past')) toggleFull(); });
  const setDelay = delay => {
    state.delay = delay;
    element('past').value = -delay;
    element('live').setAttribute('aria-pressed', String(delay === 0));
    say('past-text', delay === 0 ? 'now' : `${delay.toFixed(1)} s ago`);
  };
  element('past').oninput = event => setDelay(Math.max(0, -Number(event.target.value)));
  element('live').onclick = () => setDelay(0);
}

function animate(renderer) {
  let before = performance.now();
  const next = now => {
    const frame = shownFrame();
    const live = state.reference && frame && Math.abs(state.reference.time - frame.time) < 1;
    scene.draw(renderer, frame?.characters ?? [], live ? state.reference.pose : null, Math.min(0.1, (now - before) / 1e3), dark.matches);
    before = now;
    requestAnimationFrame(next);
  };
  requestAnimationFrame(next);
}

async function start() {
  watchControls();
  watchPointer(element('picture'));
  try {
    const renderer = new Renderer(element('picture'));
    maxHz ||= renderer.isSoftware ? 30 : 60;
    animate(renderer);
  } catch (error) {
    maxHz ||= 30;
    showPrompt(`No picture: ${error.message}. The rest of the page works.`);
  }
  const about = await enter(why => { say('status', why); say('notice', why); element('notice').hidden = false; });
  if (!about.may_view) return;
  openSessions(about.servers);
  setInterval(() => {
    showPanels();
    if (state.sensor) strips.draw(state.sensor.serverNs() * 1e-9);
  }, PANELS_EVERY_MS);
}

// For tests and the curious: what the page has seen and drawn.
window.footing = () => ({
  ticks: state.ticks, drawn: scene.drawn, age_s: state.shownAge, devices: state.devices.length,
  states: state.sessions.map(one => one.state), missed: state.sessions.map(one => one.missed ?? 0),
  frames: state.frames.length, past: state.past.length,
});
start();
