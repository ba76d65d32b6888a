// The messages in words.
import { ENUMS } from './schema.js';

const words = (enumeration, value) => (ENUMS[enumeration][value] ?? '').replaceAll('_', ' ');
const degrees = radians => (radians * 180 / Math.PI).toFixed(0);
const KINDS = { wiimote: 'Wiimote', balance_board: 'Balance Board', ps_move: 'PS Move', pro_controller: 'Pro Controller',
                inertial: 'inertial sensor' };

// Fills a list of terms and values; entries whose value is undefined are not shown.
function fill(list, entries) {
  const shown = entries.filter(([, value]) => value !== undefined);
  while (list.children.length > shown.length) list.lastChild.remove();
  while (list.children.length < shown.length) {
    const row = document.createElement('div');
    row.append(document.createElement('dt'), document.createElement('dd'));
    list.append(row);
  }
  shown.forEach(([term, value], i) => {
    const [dt, dd] = list.children[i].children;
    if (dt.textContent !== term) dt.textContent = term;
    if (dd.textContent !== value) dd.textContent = value;
  });
}

function set(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

// By its role, else by what it is.
export function nameOf(device) {
  return words('DeviceRole', device.role) || (KINDS[ENUMS.DeviceKind[device.kind]] ?? 'device');
}

// A line for each device: what it is, how it fares, and what to do about it.
export function showDevices(list, none, devices) {
  none.hidden = devices.length > 0;
  while (list.children.length > devices.length) list.lastChild.remove();
  while (list.children.length < devices.length) {
    const row = document.createElement('li');
    for (const name of ['name', 'detail', 'note']) {
      const part = document.createElement(name === 'name' ? 'span' : 'div');
      part.className = name;
      row.append(part);
    }
    list.append(row);
  }
  devices.forEach((device, i) => {
    const [name, detail, note] = list.children[i].children;
    const state = words('DeviceState', device.state);
    set(name, nameOf(device));
    list.children[i].className = state === 'live' ? '' : state === 'connecting' ? 'warn' : 'bad';
    const battery = device.battery_fraction > 0 ? `, battery ${Math.round(100 * device.battery_fraction)} %` : '';
    set(detail, `${KINDS[ENUMS.DeviceKind[device.kind]] ?? 'device'}, ${state}, ${device.report_rate_hz.toFixed(0)} Hz${battery}` +
                (device.battery_low ? ' (low)' : '') + (device.simulated ? ', simulated' : ''));
    set(note, device.note);
  });
}

// The gait in large letters, and what the interface has recognised.
export function showInterface(gait, activity, character) {
  const { body, interface: user, gait: state } = character ?? {};
  if (body) {
    set(gait, body.calibrated ? 'tracked' : 'T-pose');
    set(activity, body.note || (body.calibrated ? `${body.subject || 'unnamed'}, mode ${body.mode}`
        : `Stand in a T-pose: ${Math.round(100 * body.calibration_progress)} %`));
    return;
  }
  set(gait, state ? words('Gait', state.gait) : '-');
  const recognised = user ? `${words('UserInterface', user.interface)}: ${words('Activity', user.activity)}` : '';
  const next = state?.pending ? `, next ${words('Gait', state.commanded_gait)}` : '';
  set(activity, recognised + next);
}

export function showNumbers(list, character) {
  const { body, gait, interface: user, com_m } = character ?? {};
  const feet = body?.feet ?? [];
  fill(list, body ? [
    ['left foot', feet[0] ? `${(feet[0].load_n / 9.80665).toFixed(0)} kg` : undefined],
    ['right foot', feet[1] ? `${(feet[1].load_n / 9.80665).toFixed(0)} kg` : undefined],
    ['COM height', com_m ? `${(100 * com_m.z).toFixed(0)} cm` : undefined],
    ['hands', body.hands_source || 'not tracked'],
  ] : gait ? [
    ['speed', `${(Math.round(100 * gait.speed_mps) / 100 + 0).toFixed(2)} m/s`],  // Without -0.00.
    ['commanded', `${gait.commanded_speed_mps.toFixed(2)} m/s`],
    ['turn', `${degrees(gait.commanded_turn_rad)}° a step`],
    ['distance', `${gait.distance_m.toFixed(1)} m`],
    ['falls', String(gait.falls)],
    ['part of the step', gait.phase.replaceAll('_', ' ')],
    ['frequency', user?.frequency_valid ? `${user.frequency_hz.toFixed(2)} Hz` : undefined],
    ['phase', user?.phase_valid ? `${degrees(user.phase_rad)}°` : undefined],
  ] : []);
}

// Whole seconds as minutes and seconds, such as 1:05.
export const clockFace = seconds => `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, '0')}`;

// A countdown that had `left` seconds, `passed` seconds later.
const clock = (left, passed) => left > 0 ? clockFace(Math.ceil(Math.max(0, left - passed))) : undefined;

// Where a study stands, for the experimenter. `passed`: since that was sent, s.
export function showStudy(panel, title, doing, list, study, passed) {
  panel.hidden = !study?.participant;
  if (panel.hidden) return;
  set(title, `${study.participant}, ${study.phase}${study.attempt ? `, attempt ${study.attempt}` : ''}`);
  set(doing, study.doing);
  fill(list, [
    ['left', clock(study.left_s, passed)],
    ['phase', `${study.number} of ${study.phases}`],
    ['next', study.next],
    ['in motion', `${(study.active_s / 60).toFixed(1)} min`],
    ['keys in the terminal', study.keys || undefined],
  ]);
}

export function showTrial(panel, text, list, trial) {
  panel.hidden = !trial || (!trial.trial && !trial.finish_m);
  if (panel.hidden) return;
  set(text, trial.instruction || `${trial.trial || 'Track'}: ${words('TrialState.Phase', trial.phase)}`);
  fill(list, [
    ['time', `${trial.time_s.toFixed(1)} s`],
    ['distance', `${trial.distance_m.toFixed(1)}${trial.finish_m ? ' of ' + trial.finish_m.toFixed(0) : ''} m`],
    ['failures', String(trial.failed_attempts)],
    ...Object.entries(trial.failures ?? {}).filter(([, count]) => count > 0).map(([kind, count]) => [kind, String(count)]),
  ]);
}
