// A webcam's frames through the pose model of npm's @mediapipe/pose, all of it in this browser, and
// the joints through footing-web to footing-skeleton.
import { enter, sentence, whyClosed } from './entry.js';
import { drawFigure } from './figure.js';
import { encode, syntheticLandmarks, toJoints } from './landmarks.js';

const REDIAL_MS = 1000;

const element = id => document.getElementById(id);
const canvas = element('person'), video = element('video'), fieldOfView = element('field-of-view');
const context = canvas.getContext('2d');
const counts = { frames: 0, found: 0, sent: 0 };
// `state`: of the source; `wrong`: of the way to footing-skeleton.
let socket = null, sequence = 0, run = 0, state = 'Choose a source.', wrong = '';

function show(text) {
  state = text;
  report();
}

function report() {
  const status = wrong ? sentence(wrong) : state;
  if (element('status').textContent !== status) element('status').textContent = status;
  element('status').className = wrong ? 'bad' : '';
  for (const [name, count] of Object.entries(counts)) element(name).textContent = count;
}

function connect() {
  const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
  socket = new WebSocket(`${scheme}//${location.host}/skeleton`);
  socket.onopen = () => { wrong = ''; report(); };
  socket.onmessage = event => { wrong = event.data; report(); };
  socket.onclose = async () => {
    wrong = await whyClosed('may_track');
    report();
    setTimeout(connect, REDIAL_MS);
  };
}

function setRunning(running) {
  element('stop').hidden = !running;
  element('camera').hidden = element('synthetic').hidden = running;
  (running ? element('stop') : element('camera')).focus();
}

function draw(picture, landmarks) {
  context.clearRect(0, 0, canvas.width, canvas.height);
  if (picture) context.drawImage(picture, 0, 0, canvas.width, canvas.height);
  if (landmarks) drawFigure(context, landmarks, canvas.width, canvas.height);
}

// One exposure, made at unixMs; `image` and `world` are the model's landmarks, if it found any.
function take(picture, image, world, unixMs) {
  ++counts.frames;
  draw(picture, image);
  const joints = image && world
      ? toJoints(image, world, canvas.width, canvas.height, Number(fieldOfView.value)) : [];
  if (joints.length > 0) {
    ++counts.found;
    if (socket && socket.readyState === WebSocket.OPEN) {
      socket.send(encode(joints, 1, ++sequence, unixMs));
      ++counts.sent;
    }
  }
  report();
}

const nowMs = () => performance.timeOrigin + performance.now();

function runSynthetic() {
  const mine = ++run;
  setRunning(true);
  show('A synthetic person, no camera.');
  const began = performance.now();
  const next = () => {
    if (mine !== run) return;
    const { image, world } = syntheticLandmarks((performance.now() - began) / 1000, canvas.width,
                                                canvas.height, Number(fieldOfView.value));
    take(null, image, world, nowMs());
    setTimeout(next, 33);
  };
  next();
}

function loadModel() {
  return new Promise((resolve, reject) => {
    if (window.Pose) return resolve();
    const script = document.createElement('script');
    script.src = '/pose/pose.js';
    script.onload = resolve;
    script.onerror = () => reject(new Error(
        'the pose model is not installed: run scripts/fetch-pose-model on the computer that serves this page, and load it again'));
    document.head.append(script);
  });
}

async function runCamera() {
  const mine = ++run;
  setRunning(true);
  try {
    if (!navigator.mediaDevices) throw new Error('browsers give webcams to pages of this computer and of https only');
    show('Loading the pose model.');
    await loadModel();
    const pose = new window.Pose({ locateFile: name => '/pose/' + name });
    pose.setOptions({ modelComplexity: 1, smoothLandmarks: true, minDetectionConfidence: 0.5,
                      minTrackingConfidence: 0.5 });
    let exposedMs = 0, model = false;  // The first picture takes longest.
    pose.onResults(results => take(results.image, results.poseLandmarks,
                                   results.poseWorldLandmarks, exposedMs));
    await pose.initialize();
    show('Asking for the webcam.');
    video.srcObject = await navigator.mediaDevices.getUserMedia(
        { video: { width: 640, height: 480 }, audio: false });
    await video.play();
    canvas.width = video.videoWidth;
    canvas.height = video.videoHeight;
    show('Watching the webcam.');
    while (mine === run) {
      exposedMs = nowMs();
      await pose.send({ image: video });
      if (!model) show('The model runs on the webcam.');
      model = true;
      await new Promise(resolve => setTimeout(resolve, 0));
    }
    for (const track of video.srcObject.getTracks()) track.stop();
    await pose.close();
  } catch (error) {
    setRunning(false);
    show(`Stopped: ${error.message ?? error}.`);
  }
}

async function start() {
  const about = await enter(show);
  if (!about.may_track) return show(sentence(about.needs_code));
  element('camera').onclick = runCamera;
  element('synthetic').onclick = runSynthetic;
  element('stop').onclick = () => { ++run; setRunning(false); show('Stopped.'); };
  element('camera').disabled = element('synthetic').disabled = false;
  connect();
  const source = new URLSearchParams(location.search).get('source');
  if (source === 'camera') runCamera();
  if (source === 'synthetic') runSynthetic();
}

// For tests and the curious.
window.footing = () => ({ ...counts, state, wrong });
start();
