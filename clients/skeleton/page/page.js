// A webcam's frames through the pose model of npm's @mediapipe/pose, all of it in this browser, and
// the joints to footing-skeleton, which serves this page.
import { drawFigure } from './figure.js';
import { encode, syntheticLandmarks, toJoints } from './landmarks.js';

const canvas = document.getElementById('picture');
const context = canvas.getContext('2d');
const video = document.getElementById('video');
const fieldOfView = document.getElementById('field-of-view');
const counts = { frames: 0, found: 0, sent: 0 };
let socket = null, sequence = 0, run = 0, state = '';

function show(text) {
  state = text;
  document.getElementById('state').textContent = text;
  report();
}

function report() {
  document.getElementById('counts').textContent =
      `${counts.frames} frames, ${counts.found} with a person, ${counts.sent} sent`;
  if (socket && socket.readyState === WebSocket.OPEN)
    socket.send(JSON.stringify({ frames: counts.frames, found: counts.found, state }));
}

function connect() {
  socket = new WebSocket(`ws://${location.host}/skeleton`);
  socket.onopen = report;
  socket.onclose = () => setTimeout(connect, 1000);
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
  show('a synthetic person, no camera');
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
        'the pose model is not installed: run scripts/fetch-pose-model and load this page again'));
    document.head.append(script);
  });
}

async function runCamera() {
  const mine = ++run;
  try {
    show('loading the pose model');
    await loadModel();
    const pose = new window.Pose({ locateFile: name => '/pose/' + name });
    pose.setOptions({ modelComplexity: 1, smoothLandmarks: true, minDetectionConfidence: 0.5,
                      minTrackingConfidence: 0.5 });
    let exposedMs = 0, model = false;  // The first picture takes longest.
    pose.onResults(results => take(results.image, results.poseLandmarks,
                                   results.poseWorldLandmarks, exposedMs));
    await pose.initialize();
    show('asking for the webcam');
    video.srcObject = await navigator.mediaDevices.getUserMedia(
        { video: { width: 640, height: 480 }, audio: false });
    await video.play();
    canvas.width = video.videoWidth;
    canvas.height = video.videoHeight;
    show('watching the webcam');
    while (mine === run) {
      exposedMs = nowMs();
      await pose.send({ image: video });
      if (!model) show('the model runs on the webcam');
      model = true;
      await new Promise(resolve => setTimeout(resolve, 0));
    }
    for (const track of video.srcObject.getTracks()) track.stop();
    await pose.close();
  } catch (error) {
    show('stopped: ' + (error.message ?? error));
  }
}

document.getElementById('camera').onclick = runCamera;
document.getElementById('synthetic').onclick = runSynthetic;
document.getElementById('stop').onclick = () => { ++run; show('stopped'); };
connect();
show('choose a source');
const source = new URLSearchParams(location.search).get('source');
if (source === 'camera') runCamera();
if (source === 'synthetic') runSynthetic();
