// Times of three.js's AnimationMixer: node recorded.mjs THREE_MODULE SKELETON.json
// The file holds "parents" (-1 for the root), "figures", "rounds" and "keys"; every bone has a track of rotations.
import { readFileSync } from 'node:fs';
const THREE = await import(process.argv[2]);
const { parents, figures, rounds, keys } = JSON.parse(readFileSync(process.argv[3]));
const times = Array.from({ length: keys }, (_, k) => k / 60);
const turn = (bone, k) => new THREE.Quaternion().setFromEuler(
  new THREE.Euler(Math.sin(k / 5 + bone), Math.cos(k / 7 + bone), Math.sin(k / 9 - bone))).toArray();
const tracks = parents.map((_, bone) => new THREE.QuaternionKeyframeTrack(
  `b${bone}.quaternion`, times, times.flatMap((_, k) => turn(bone, k))));
tracks.push(new THREE.VectorKeyframeTrack('b0.position', times, times.flatMap((t) => [t, 0, 0.9])));
const clip = new THREE.AnimationClip('walk', -1, tracks);
const all = Array.from({ length: figures }, (_, n) => {
  const bones = parents.map((parent, bone) => {
    const made = new THREE.Bone();
    made.name = `b${bone}`;
    made.position.set(0, 0, 0.2);
    return made;
  });
  bones.forEach((bone, k) => { if (parents[k] >= 0) bones[parents[k]].add(bone); });
  const mixer = new THREE.AnimationMixer(bones[0]);
  mixer.clipAction(clip).play();
  mixer.update(n / figures);
  return { mixer, root: bones[0] };
});
const seconds = { update: [], both: [] };
for (let round = 0; round < rounds; round++) {
  const begin = performance.now();
  for (const each of all) each.mixer.update(1 / 60);
  const middle = performance.now();
  for (const each of all) each.root.updateMatrixWorld(true);
  seconds.update.push(middle - begin);
  seconds.both.push(performance.now() - begin);
}
const best = (list) => Math.min(...list);
console.log(JSON.stringify({ update: best(seconds.update), both: best(seconds.both), version: THREE.REVISION }));
