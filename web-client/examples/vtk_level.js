// A level of detail in vtk.js: a .glb with Draco and the first field's colours. The decoder is
// npm's draco3d, or three's.
/* global DracoDecoderModule */
import '@kitware/vtk.js/Rendering/Profiles/Geometry';
import GenericRenderWindow from '@kitware/vtk.js/Rendering/Misc/GenericRenderWindow';
import GLTFImporter from '@kitware/vtk.js/IO/Geometry/GLTFImporter';
import {level} from './page.js';

const container = document.body.appendChild(document.createElement('div'));
container.style = 'width: 100vw; height: 100vh';
const window3d = GenericRenderWindow.newInstance({background: [1, 1, 1]});
window3d.setContainer(container);
const importer = GLTFImporter.newInstance({renderer: window3d.getRenderer()});
await importer.setDracoDecoder(DracoDecoderModule);
importer.onReady(() => {
  importer.importActors();
  window3d.getRenderer().resetCamera();
  window3d.resize();
});
await importer.setUrl(level('glb', 50000), {binary: true});
