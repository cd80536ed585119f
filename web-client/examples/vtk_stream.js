// A stream in vtk.js: the boundary as vtkPolyData, a finer one as often as more has come. `npm
// install qtet @kitware/vtk.js`
import '@kitware/vtk.js/Rendering/Profiles/Geometry';
import {Client, kPlainDisplay} from 'qtet/core';
import Actor from '@kitware/vtk.js/Rendering/Core/Actor';
import DataArray from '@kitware/vtk.js/Common/Core/DataArray';
import FullScreen from '@kitware/vtk.js/Rendering/Misc/FullScreenRenderWindow';
import Mapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import PolyData from '@kitware/vtk.js/Common/DataModel/PolyData';
import {log} from './page.js';

const screen = FullScreen.newInstance({background: [1, 1, 1]});
const [mapper, actor, mesh] = [Mapper, Actor, PolyData].map((kind) => kind.newInstance());
actor.setMapper(mapper);
mapper.setInputData(mesh);
const client = new Client(({type, fields, snapshot}) => {
  if (type === 'manifest')
    client.show({...kPlainDisplay, color: {field: fields[0] ?? 0, component: -1}});
  if (type !== 'snapshot' || !snapshot.surface) return;
  const {positions, values} = snapshot.surface;
  mesh.getPoints().setData(positions, 3);
  mesh
    .getPolys()
    .setData(
      Uint32Array.from({length: (4 * positions.length) / 9}, (_, i) =>
        i % 4 ? 3 * (i >> 2) + (i % 4) - 1 : 3,
      ),
    );
  mesh.getPointData().setScalars(DataArray.newInstance({name: 'field', values}));
  mesh.modified();
  if (!screen.getRenderer().hasViewProp(actor))
    (screen.getRenderer().addActor(actor), screen.getRenderer().resetCamera());
  screen.getRenderWindow().render();
  client.shown();
});
client.start({log});
