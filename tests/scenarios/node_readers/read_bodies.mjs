// Reads exported bodies with three's BVHLoader and GLTFLoader, and checks .glb with Khronos' gltf-validator.
// Usage: node read_bodies.mjs TIME_S FILE...; prints each file's joints at that time, in the file's units, as JSON.
// Runs from a copy beside node_modules.
import {readFile} from "node:fs/promises";
import validator from "gltf-validator";
import * as three from "three";
import {BVHLoader} from "three/examples/jsm/loaders/BVHLoader.js";
import {GLTFLoader} from "three/examples/jsm/loaders/GLTFLoader.js";

function jointsAt(root, clip, time_s, isJoint) {
  const mixer = new three.AnimationMixer(root);
  mixer.clipAction(clip).play();
  mixer.setTime(time_s);
  root.updateMatrixWorld(true);
  const joints = {};
  root.traverse(node => {
    if (isJoint(node)) joints[node.name] = new three.Vector3().setFromMatrixPosition(node.matrixWorld).toArray();
  });
  const times = clip.tracks.map(track => track.times);
  return {
    joints,
    duration_s: clip.duration,
    tracks: clip.tracks.length,
    rising: times.every(row => row.every((at, i) => i === 0 || at > row[i - 1])),
    finite: clip.tracks.every(track => track.values.every(Number.isFinite)),
  };
}

function readBvh(text, time_s) {
  const {skeleton, clip} = new BVHLoader().parse(text);
  return jointsAt(skeleton.bones[0], clip, time_s, node => node.isBone && node.name !== "ENDSITE");
}

async function readGlb(bytes, time_s) {
  const {issues} = await validator.validateBytes(new Uint8Array(bytes));
  const gltf = await new GLTFLoader().parseAsync(
      bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), "");
  const seen = jointsAt(gltf.scene, gltf.animations[0], time_s, node => node.name !== "" && !node.isMesh);
  const {numErrors, numWarnings, messages} = issues;
  return {...seen, errors: numErrors, warnings: numWarnings, messages};
}

const [time, ...paths] = process.argv.slice(2);
const seen = [];
for (const path of paths) {
  const bytes = await readFile(path);
  seen.push(path.endsWith(".glb") ? await readGlb(bytes, Number(time)) : readBvh(bytes.toString(), Number(time)));
}
console.log(JSON.stringify(seen));
