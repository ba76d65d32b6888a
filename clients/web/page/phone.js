// A phone as a controller: its motion goes to footingd as the reports of an inertial sensor.
import { enter, sentence, whyClosed } from './entry.js';
import { MOST_SAMPLES, reportOf, SignFinder } from './motion.js';
import { decode, encode } from './protobuf.js';
import { ENUMS } from './schema.js';
import { Session } from './session.js';

const VENDOR = 0xf007, PRODUCT = 1;
// Motion that is made up, such as by a test, says so.
const SIMULATED = new URLSearchParams(location.search).has('simulated');
const VIBRATE = 2, VIBRATION_MS = 500, STEP_MS = 30;
const NO_MOTION_AFTER_MS = 2000, REDIAL_MS = 500;
const MOST_WAITING = 240;  // Samples: 4 s. Older ones are of no use, and are counted as lost.
const MOST_BUFFERED_BYTES = 2048;
// Where a browser opens no WebSocket (iOS to a host whose certificate is not installed), requests.
const FAILURES_UNTIL_POST = 2, POST_EVERY_MS = 20;
const POST = new URLSearchParams(location.search).has('post');

const element = id => document.getElementById(id);
const say = text => { if (element('status').textContent !== text) element('status').textContent = text; };

// State from Start to Stop.
let run = null;
let about = null;

// The same name at each visit, so that its role stays.
function serialOfThis() {
  let serial = localStorage.getItem('footing-serial');
  if (!serial) {
    serial = 'phone-' + [...crypto.getRandomValues(new Uint8Array(6))].map(byte => byte.toString(16).padStart(2, '0')).join('');
    localStorage.setItem('footing-serial', serial);
  }
  return serial;
}

function nameOfThis() {
  const model = /\(([^;)]+;\s*)?([^;)]+)/.exec(navigator.userAgent)?.[2] ?? 'phone';
  return `web page on ${model}`.replace(/[^ -~]/g, '').slice(0, 60);
}

const isApple = () => /iPhone|iPad|iPod/.test(navigator.userAgent) ||
    (/Macintosh/.test(navigator.userAgent) && navigator.maxTouchPoints > 1);

async function permitted() {
  for (const kind of [window.DeviceMotionEvent, window.DeviceOrientationEvent]) {
    if (typeof kind?.requestPermission !== 'function') continue;
    if (await kind.requestPermission() !== 'granted') return false;
  }
  return true;
}

function takeMotion(event) {
  const { x, y, z } = event.accelerationIncludingGravity ?? {};
  if (typeof x !== 'number' || typeof y !== 'number' || typeof z !== 'number') return;
  const { alpha, beta, gamma } = event.rotationRate ?? {};
  const rate = [alpha, beta, gamma].every(Number.isFinite) ? [alpha, beta, gamma] : null;
  const us = Math.max(run.lastUs + 1, Math.round(event.timeStamp * 1e3));
  run.lastUs = us;
  run.sign.feel([x, y, z]);
  run.feels = [x, y, z];
  ++run.events;
  run.waiting.push({ us, acceleration: [x, y, z], rate });
  if (run.waiting.length > MOST_WAITING) {
    run.waiting.shift();
    ++run.lost;
  }
  flush();
}

const attachMessage = () => encode('DeviceEnvelope', { attach: {
  slot: 0, bus: 0, vendor: VENDOR, product: PRODUCT, name: nameOfThis(), serial: serialOfThis(),
  role: run.role, hardware: !SIMULATED } });

// The samples that wait, as messages.
function reports() {
  const messages = [];
  while (run.waiting.length) {
    const samples = run.waiting.splice(0, MOST_SAMPLES);
    const report = reportOf(samples, run.number++, { inverted: run.sign.inverted, battery: run.battery });
    messages.push(encode('DeviceEnvelope', { input_report: { slot: 0, sequence: run.number, report } }));
  }
  return messages;
}

function flush() {
  const { socket } = run;
  if (!run.attached || socket?.readyState !== WebSocket.OPEN || socket.bufferedAmount > MOST_BUFFERED_BYTES) return;
  for (const message of reports()) socket.send(message);
}

// Each message behind its length, as the protocol has them.
function framed(messages) {
  const bytes = [];
  for (const message of messages) {
    for (let i = 0; i < 4; ++i) bytes.push(message.length >> 8 * i & 255);
    bytes.push(...message);
  }
  return Uint8Array.from(bytes);
}

function takeFrames(bytes) {
  const view = new DataView(bytes.buffer);
  for (let at = 0; at + 4 <= bytes.length;) {
    const size = view.getUint32(at, true);
    takeDevice(decode('DeviceEnvelope', bytes.subarray(at + 4, at + 4 + size)));
    at += 4 + size;
  }
}

async function post() {
  const mine = run;
  mine.attached = false;
  while (run === mine) {
    const messages = mine.attached ? reports() : [attachMessage()];
    try {
      const answer = await fetch('/devices', { method: 'POST', body: framed(messages) });
      if (run !== mine) return;
      if (!answer.ok) throw new Error((await answer.text()).trim());
      takeFrames(new Uint8Array(await answer.arrayBuffer()));
      mine.attached = true;
      element('way').textContent = 'requests';
    } catch (error) {
      mine.attached = false;
      if (run === mine) say(`Not connected: ${error.message}. Trying again.`);
      await new Promise(done => setTimeout(done, REDIAL_MS));
    }
    await new Promise(done => setTimeout(done, POST_EVERY_MS));
  }
}

function dial() {
  const mine = run, scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
  const socket = new WebSocket(`${scheme}//${location.host}/devices`);
  socket.binaryType = 'arraybuffer';
  run.socket = socket;
  run.attached = false;
  run.why = '';
  socket.onopen = () => {
    if (run !== mine) return socket.close();
    socket.send(attachMessage());
    mine.attached = true;
    mine.failures = 0;
    element('way').textContent = 'WebSocket';
    say(`Sending. ${mine.sign.known ? '' : 'Hold the phone still for a second.'}`);
  };
  socket.onmessage = event => takeDevice(decode('DeviceEnvelope', new Uint8Array(event.data)));
  socket.onclose = async event => {
    mine.attached = false;
    mine.why ||= event.reason || await whyClosed('may_attach');
    if (run !== mine) return;
    element('way').textContent = '-';
    if (mine.failures !== 0 && ++mine.failures > FAILURES_UNTIL_POST) return post();
    say(`Not connected: ${mine.why}. Trying again.`);
    setTimeout(() => { if (run === mine) dial(); }, REDIAL_MS);
  };
}

function takeDevice(message) {
  if (message.refused) {
    run.why = message.refused.reason;
    say(`Refused: ${run.why}.`);
  } else if (message.output?.report[0] === VIBRATE) {
    navigator.vibrate?.(message.output.report[1] ? VIBRATION_MS : 0);
  }
}

async function keepAwake() {
  try {
    run.wakeLock = await navigator.wakeLock?.request('screen');
  } catch {
    // Without it the screen may go dark, and the page then says what was not sent.
  }
}

// The gait, and a short vibration when the foot of this phone's side comes down.
function follow(count) {
  for (let i = 0; i < count; ++i) {
    let touching = false;
    const session = new Session({ path: `/session/${i}`, name: 'phone', channels: ['characters'], maxHz: 30 }, {
      onWelcome() {}, onGap() {}, onState() {},
      onTick(tick) {
        const character = tick.characters?.characters[0];
        if (!character?.gait || !run) return;
        element('gait').textContent = ENUMS.Gait[character.gait.gait] ?? '-';
        const now = character.contacts[run.role % 2 === 1 ? 0 : 1]?.touching ?? false;
        if (now && !touching && element('feel').checked) navigator.vibrate?.(STEP_MS);
        touching = now;
      },
    });
    run.sessions.push(session);
  }
}

function drawLevel() {
  if (!run) return;
  const canvas = element('level'), context = canvas.getContext('2d'), style = getComputedStyle(canvas);
  const [x, y, z] = (run.feels ?? [0, 0, 0]).map(value => run.sign.inverted ? -value : value);
  const middle = canvas.width / 2, reach = middle - 20;
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.strokeStyle = style.color;
  context.beginPath();
  context.arc(middle, middle, reach, 0, 2 * Math.PI);
  context.moveTo(middle + 18, middle);
  context.arc(middle, middle, 18, 0, 2 * Math.PI);
  context.stroke();
  const scale = reach / Math.max(9.8, Math.hypot(x, y));
  context.fillStyle = z < 0 ? '#c62828' : '#1f7a4d';
  context.beginPath();
  context.arc(middle + scale * x, middle - scale * y, 14, 0, 2 * Math.PI);
  context.fill();
  requestAnimationFrame(drawLevel);
}

function watch() {
  if (!run) return;
  const now = performance.now();
  element('rate').textContent = String(Math.round(1e3 * (run.events - run.shownEvents) / (now - run.shownAt)));
  element('lost').textContent = String(run.lost);
  if (run.events === 0 && now - run.began > NO_MOTION_AFTER_MS) {
    say('This device reports no motion. ' + (isSecureContext ? 'Use a phone, and allow motion sensors for this page.'
        : 'Browsers do so on https pages only: scan the QR code again.'));
  } else if (run.attached && run.events > 0) {
    say(document.hidden ? 'Hidden.' : 'Sending.');
  }
  run.shownEvents = run.events;
  run.shownAt = now;
}

async function start() {
  if (!await permitted()) return say('Motion sensors are not allowed for this page: allow them in the settings of the browser, and tap Start again.');
  const role = Number(document.querySelector('input[name="role"]:checked').value);
  const now = performance.now();
  run = { role, number: 0, failures: 1, waiting: [], lost: 0, events: 0, shownEvents: 0, shownAt: now, began: now, lastUs: 0,
          sign: new SignFinder(isApple()), sessions: [], why: '' };
  localStorage.setItem('footing-role', String(role));
  navigator.getBattery?.().then(battery => { if (run) run.battery = Math.round(100 * battery.level); });
  addEventListener('devicemotion', takeMotion);
  addEventListener('deviceorientation', takeOrientation);
  say('Connecting.');
  if (POST) post();
  else dial();
  keepAwake();
  follow(about.servers);
  show(true);
  drawLevel();
}

function takeOrientation(event) {
  run?.sign.orient(event.beta, event.gamma);
}

function stop() {
  removeEventListener('devicemotion', takeMotion);
  removeEventListener('deviceorientation', takeOrientation);
  const { socket, sessions, wakeLock } = run;
  run = null;
  if (socket) socket.close();  // Which detaches it.
  else fetch('/devices', { method: 'POST', body: framed([encode('DeviceEnvelope', { detach: { slot: 0, reason: 'stopped' } })]) });
  for (const session of sessions) session.end();
  wakeLock?.release();
  navigator.vibrate?.(0);
  show(false);
  say('Stopped. Nothing is sent.');
}

function show(running) {
  element('start').hidden = element('roles').hidden = running;
  element('stop').hidden = element('running').hidden = !running;
  element('feel-label').hidden = !navigator.vibrate;
  (running ? element('stop') : element('start')).focus();
}

let hiddenAt = 0;
document.addEventListener('visibilitychange', () => {
  if (document.hidden) {
    hiddenAt = performance.now();
  } else if (run) {
    run.hiddenS = (run.hiddenS ?? 0) + (performance.now() - hiddenAt) / 1e3;
    say(`The page was hidden for ${run.hiddenS.toFixed(1)} s in all: no motion was sent then.`);
    keepAwake();
  }
});

async function prepare() {
  const role = localStorage.getItem('footing-role');
  if (role) document.querySelector(`input[name="role"][value="${role}"]`).checked = true;
  about = await enter(say);
  if (!about.may_attach) return say(sentence(about.needs_code));
  element('start').disabled = false;
  element('start').onclick = start;
  element('stop').onclick = stop;
  setInterval(watch, 1000);
}

// For tests and the curious.
window.footing = () => run && { events: run.events, lost: run.lost, attached: run.attached, number: run.number,
                                signKnown: run.sign.known, inverted: run.sign.inverted };
prepare();
