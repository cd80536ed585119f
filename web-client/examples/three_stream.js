// A stream in three.js: each picture finer than the one before, cut open, while the rest is still
// on its way. `npm install qtet three`
import {Client, kPlainDisplay} from 'qtet/core';
import {MeshView} from 'qtet/three';
import {log} from './page.js';

const canvas = document.body.appendChild(document.createElement('canvas'));
canvas.style = 'width: 100vw; height: 100vh';
const view = new MeshView(canvas);
view.setLook({map: 'viridis', reversed: false, edges: true, opacity: 1});
const client = new Client((message) => {
  if (message.type === 'manifest')
    client.show({...kPlainDisplay, color: {field: message.fields[0] ?? 0, component: -1}});
  if (message.type === 'error') console.error(message.message);
  if (message.type !== 'snapshot') return;
  const {scaleRange, statistics} = message.snapshot;
  view.setRange(...scaleRange, scaleRange, false);
  view.show(message.snapshot, () => client.shown());
  document.title = `${statistics.tetrahedra} of ${statistics.total.tetrahedra} cells`;
});
client.start({log});
