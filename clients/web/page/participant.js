// The participant's screen of a study: what comes next, as footing-view --subject says it, and the survey of
// footing-study, one question at a time. Each answer is in the study's journal before the next question comes.
import { enter, sentence, whyClosed } from './entry.js';
import { clockFace } from './panels.js';
import { ENUMS } from './schema.js';
import { Session } from './session.js';

const REDIAL_MS = 1000, SHOW_EVERY_MS = 100, MAX_HZ = 10;
const GO_S = 1;
const RUNNING = 2;  // Of TrialState.Phase: from the start line on.

const element = id => document.getElementById(id);
const say = (id, text) => { if (element(id).textContent !== text) element(id).textContent = text; };

// The study's state and when it came, the trial, and what the survey shows (number 0: a message).
const state = { study: null, at: 0, trial: null, shown: null, sent: false, sessions: [], wrong: '' };
let socket = null;

function phaseWords(phase) {
  const end = phase.lastIndexOf('.'), kind = phase.slice(end + 1), user = phase.slice(0, Math.max(0, end));
  if (kind.startsWith('straight') || kind === 'test') return 'Next: a trial';
  const words = { rest: 'a rest', demonstration: `the interface ${user}`, practice: `practice of the interface ${user}`,
                  ranges: 'your own movements', survey: `questions about the interface ${user}`,
                  final_survey: 'the last questions' }[kind];
  return words ? `Next: ${words}` : '';
}

const clockText = left => left > 0 ? clockFace(Math.ceil(left)) : '';

// Headline, countdown and detail of an instruction.
function instruction() {
  const { study, trial } = state;
  if (!study?.participant) return ['Please wait', '', 'The study has not begun.'];
  const left = study.left_s - (performance.now() - state.at) / 1e3, clock = study.left_s > 0 ? clockText(left) : '';
  const counts = trial?.phase !== RUNNING && study.left_s > 0 && left > -GO_S;
  const rests = study.phase.endsWith('rest') ? study.next : study.phase;
  const text = {
    demonstration: [`Demonstration of the interface ${study.interface}`],
    ranges: ['Move as the experimenter says'],
    practice: ['Practice', clock],
    get_ready: ['Get ready', '', 'The trial begins after 3, 2, 1'],
    trial: ['Trial', counts ? left > 0 ? String(Math.ceil(left)) : 'Go!' : '', trial?.instruction ?? ''],
    finished: ['Finished', '', phaseWords(study.next)],
    stopped: ['The trial is over', '', phaseWords(study.next)],
    rest: ['Rest', clock, phaseWords(rests)],
    survey: ['Questions', '', state.shown?.item ?? 'Please answer the experimenter.'],
  }[ENUMS.StudyActivity[study.activity]];
  return text ?? ['Please wait'];
}

function show() {
  const asks = state.shown?.number > 0;
  element('instruction').hidden = asks;
  element('survey').hidden = !asks;
  const [headline, count = '', detail = ''] = instruction();
  say('study', state.study?.study || 'Study');
  say('headline', headline);
  say('count', count);
  say('detail', detail);
  const lost = state.sessions.find(one => one.state === 'refused' || one.shownWhy);
  say('status', state.sent ? 'Saving your answer.' : sentence(state.wrong || (state.study ? '' : lost?.shownWhy ?? '')));
}

function showQuestion(shown) {
  const { least, greatest, choices, scale } = shown, rates = least < greatest;
  say('place', `${shown.title}, question ${shown.position} of ${shown.count}`);
  say('item', shown.item);
  say('scale', scale);
  const values = rates ? Array.from({ length: greatest - least + 1 }, (_, i) => String(least + i)) : choices;
  element('choices').className = rates ? 'ratings' : '';
  element('choices').replaceChildren(...values.map(value => {
    const label = document.createElement('label'), input = document.createElement('input');
    Object.assign(input, { type: 'radio', name: 'choice', value, required: true });
    label.append(input, value);
    return label;
  }));
  element('text').hidden = values.length > 0;
  element('text').value = '';
  (element('choices').querySelector('input') ?? element('text')).focus();
}

function take(shown) {
  const before = state.shown;
  state.shown = shown;
  state.sent = false;
  element('next').disabled = false;
  show();
  // After a broken connection the same question keeps what was chosen.
  if (shown.number > 0 && JSON.stringify(shown) !== JSON.stringify(before)) showQuestion(shown);
}

function answer(event) {
  event.preventDefault();
  if (socket?.readyState !== WebSocket.OPEN) return;
  const chosen = element('choices').querySelector('input:checked');
  const text = chosen ? chosen.value : element('text').value.replace(/\s+/g, ' ').trim();
  socket.send(JSON.stringify({ number: state.shown.number, text }));
  state.sent = element('next').disabled = true;
  show();
}

function connect() {
  const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
  socket = new WebSocket(`${scheme}//${location.host}/survey`);
  socket.binaryType = 'arraybuffer';
  socket.onmessage = event => {
    state.wrong = '';
    take(JSON.parse(new TextDecoder().decode(event.data)));
  };
  socket.onclose = async event => {
    // Without footing-study there is no survey yet.
    state.wrong = event.reason ? '' : await whyClosed('may_answer');
    state.sent = false;
    element('next').disabled = true;
    if (event.reason) state.shown = null;
    show();
    setTimeout(connect, REDIAL_MS);
  };
}

function follow(count) {
  for (let i = 0; i < count; ++i) {
    state.sessions.push(new Session({ path: `/session/${i}`, name: 'participant', channels: ['study', 'characters'], maxHz: MAX_HZ }, {
      onWelcome() {}, onGap() {}, onState: show,
      onTick(tick) {
        if (tick.study) Object.assign(state, { study: tick.study, at: performance.now() });
        if (tick.characters) state.trial = tick.characters.characters[0]?.trial;
      },
    }));
  }
}

async function keepAwake() {
  try {
    if (!document.hidden) await navigator.wakeLock?.request('screen');
  } catch {
    // Without it the screen may go dark.
  }
}

async function start() {
  const about = await enter(text => say('status', text));
  if (!about.may_answer) return say('status', sentence(about.needs_code));
  element('survey').onsubmit = answer;
  document.addEventListener('visibilitychange', keepAwake);
  keepAwake();
  follow(about.servers);
  connect();
  setInterval(show, SHOW_EVERY_MS);
}

// For tests and the curious.
window.footing = () => ({ study: state.study, shown: state.shown, sent: state.sent, wrong: state.wrong });
start();
