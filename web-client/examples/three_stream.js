// A stream in three.js: each picture finer than the one before, while the rest is still on its way.
// `npm install qtet three`
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {Client, kPlainDisplay} from 'qtet/core';
import {SoupMesh} from 'qtet/three';
import {log} from './page.js';

const renderer = new THREE.WebGLRenderer({antialias: true});
renderer.setSize(innerWidth, innerHeight);
document.body.append(renderer.domElement);
const surface = new SoupMesh(true);
surface.material.setColorMap('viridis', false);
const scene = new THREE.Scene().add(surface);
const camera = new THREE.PerspectiveCamera(40, innerWidth / innerHeight, 1e-2, 1e2);
camera.position.set(1.5, 1, 2.2);
new OrbitControls(camera, renderer.domElement);
renderer.setAnimationLoop(() => renderer.render(scene, camera));

const client = new Client((message) => {
  if (message.type === 'manifest')
    client.show({...kPlainDisplay, color: {field: message.fields[0] ?? 0, component: -1}});
  if (message.type === 'error') console.error(message.message);
  if (message.type !== 'snapshot') return;
  const {bounds, scaleRange, statistics} = message.snapshot;
  if (message.snapshot.surface) surface.show(message.snapshot.surface);
  surface.material.setRange(...scaleRange, scaleRange, false);
  const box = new THREE.Box3().setFromArray(bounds);
  const {center, radius} = box.getBoundingSphere(new THREE.Sphere());
  surface.scale.setScalar(1 / radius);
  surface.position.copy(center).multiplyScalar(-1 / radius);
  client.shown();
  document.title = `${statistics.tetrahedra} of ${statistics.total.tetrahedra} cells`;
});
client.start({log});
