// A level of detail in three.js: a .glb with Draco and the first field's colours.
import * as THREE from 'three';
import {DRACOLoader} from 'three/addons/loaders/DRACOLoader.js';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {level} from './page.js';

const renderer = new THREE.WebGLRenderer({antialias: true});
renderer.setSize(innerWidth, innerHeight);
document.body.append(renderer.domElement);
const scene = new THREE.Scene().add(new THREE.HemisphereLight(0xffffff, 0x888888, 3));
const camera = new THREE.PerspectiveCamera(40, innerWidth / innerHeight, 1e-3, 1e3);
const loader = new GLTFLoader().setDRACOLoader(new DRACOLoader());
const mesh = (await loader.loadAsync(level('glb', 50000))).scene;
const {center, radius} = new THREE.Box3().setFromObject(mesh).getBoundingSphere(new THREE.Sphere());
mesh.position.copy(center).negate();
scene
  .add(new THREE.Group().add(mesh))
  .children.at(-1)
  .scale.setScalar(1 / radius);
camera.position.set(1.5, 1, 2.2);
new OrbitControls(camera, renderer.domElement);
renderer.setAnimationLoop(() => renderer.render(scene, camera));
