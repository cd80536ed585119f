// The volume, compared with a formula for a box; and the user's controls for it.

import assert from 'node:assert/strict';
import {hides, kDesktop, kPhone, kScene, kSmallDesktop} from './browser.mjs';
import {coloredShare, differingShare, largestDifference, readPng} from './png.mjs';
import {serveMesh} from './programs.mjs';

/**
 * A box of 1 x 2 x 3 with the field x, and `others` that are functions of the place. It has n cubes
 * along the shortest side and six tetrahedra a cube. `keeps` chooses cubes; the mesh then has a
 * cell field, too.
 */
export function linearBox(n, others = {}, keeps = null) {
  const sizes = [n, 2 * n, 3 * n];
  const id = (x, y, z) => (z * (sizes[1] + 1) + y) * (sizes[0] + 1) + x;
  const points = [];
  const cells = [];
  for (let z = 0; z <= sizes[2]; ++z)
    for (let y = 0; y <= sizes[1]; ++y)
      for (let x = 0; x <= sizes[0]; ++x) points.push([x / n, y / n, z / n]);
  const corner = (x, y, z, bits) => id(x + (bits & 1), y + ((bits >> 1) & 1), z + (bits >> 2));
  const sixths = [
    [1, 3],
    [3, 2],
    [2, 6],
    [6, 4],
    [4, 5],
    [5, 1],
  ];
  for (let z = 0; z < sizes[2]; ++z)
    for (let y = 0; y < sizes[1]; ++y)
      for (let x = 0; x < sizes[0]; ++x) {
        if (keeps && !keeps(x, y, z)) continue;
        for (const [p, q] of sixths) cells.push([0, p, q, 7].map((bits) => corner(x, y, z, bits)));
      }
  const array = (type, name, values, components = 1) =>
    `<DataArray type="${type}" Name="${name}" NumberOfComponents="${components}" ` +
    `format="ascii">${values.join(' ')}</DataArray>`;
  const fields = Object.entries({x: (x) => x, ...others}).map(([name, value]) => {
    const values = points.map((place) => value(...place));
    return array('Float32', name, values.flat(), [values[0]].flat().length);
  });
  const which = cells.map((_, i) => (7 * i) % 12);
  const offsets = cells.map((_, i) => 4 * i + 4);
  const types = cells.map(() => 10);
  return `<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="${points.length}" NumberOfCells="${cells.length}">
<PointData>${fields.join('')}</PointData>
${keeps ? `<CellData>${array('Float32', 'which', which)}</CellData>` : ''}
<Points>${array('Float32', 'Points', points.flat(), 3)}</Points>
<Cells>${array('Int64', 'connectivity', cells.flat())}
${array('Int64', 'offsets', offsets)}${array('UInt8', 'types', types)}</Cells>
</Piece></UnstructuredGrid></VTKFile>`;
}

/**
 * RGBA in 0..255 at lattice points, given as shares of the box, in a picture with all its pixels.
 */
export function pixelsAt(viewer, places) {
  return viewer.page.evaluate(async (shares) => {
    const {meshView, viewing} = window.qtetViewer;
    const {bounds} = viewing.mesh.base;
    const picture = await createImageBitmap(await meshView.picture('transparent'));
    const context = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
    context.drawImage(picture, 0, 0);
    return shares.map((share) => {
      const {x, y} = meshView.project(
        share.map((s, axis) => bounds[axis] + s * (bounds[axis + 3] - bounds[axis])),
      );
      return [
        ...context.getImageData(
          Math.round((x * picture.width) / meshView.canvas.clientWidth),
          Math.round((y * picture.height) / meshView.canvas.clientHeight) - 1,
          1,
          1,
        ).data,
      ];
    });
  }, places);
}

async function drawsAVolumeAsTheFormulaSays(context) {
  const {server, browser} = context;
  await serveMesh(context, 'linear', linearBox(4));
  const kOpacity = 0.3,
    kPath = 0.1; // the last opacity, and its path as a share of the diagonal
  const extinction = -Math.log(1 - kOpacity) / kPath / Math.hypot(1, 2, 3);
  const viewer = await browser.open(
    `${server.url}?mesh=linear&field=x&volume=0,${kOpacity}&projection=parallel&colormap=grey`,
  );
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const notes = [];
  const expectClose = (pixels, depths, what) =>
    pixels.forEach(([, , , alpha], i) => {
      const expected = 255 * (1 - Math.exp(-depths[i]));
      notes.push(Math.abs(alpha - expected));
      assert.ok(
        Math.abs(alpha - expected) < 2,
        `${what}: ${alpha} instead of ${expected.toFixed(1)} (${JSON.stringify(pixels)})`,
      );
    });
  const look = async (direction) => {
    await viewer.page.evaluate((way) => window.qtetViewer.look(way), direction);
    await viewer.restVolume();
  };
  const at = [0.13, 0.4, 0.62, 0.9];
  await look('-y'); // along y, 2 long, the value is constant
  expectClose(
    await pixelsAt(
      viewer,
      at.map((x) => [x, 0.5, 0.37]),
    ),
    at.map((x) => extinction * x * 2),
    'along the level sets',
  );
  await look('+x'); // along x, 1 long, it goes from 0 to 1
  expectClose(
    await pixelsAt(
      viewer,
      at.map((z) => [0.5, 0.3, z]),
    ),
    at.map(() => extinction / 2),
    'across the level sets',
  );
  await viewer.page.evaluate(() => window.qtetViewer.setAttribute('clip', 'x:0.6'));
  await viewer.restVolume();
  const [low, high] = await viewer.page.evaluate(() =>
    [0, 3].map((i) => window.qtetViewer.viewing.mesh.base.bounds[i]),
  );
  const cut = (Math.floor(low + 0.6 * (high - low)) + 0.5 - low) / (high - low);
  expectClose(
    await pixelsAt(
      viewer,
      at.map((z) => [0.2, 0.7, z]),
    ),
    at.map(() => (extinction * cut * cut) / 2),
    'clipped',
  );
  await viewer.screenshot('volume-linear');
  assert.deepEqual(viewer.problems, []);
  return `${notes.length} pixels, at most ${Math.max(...notes).toFixed(2)} of 255 off`;
}

async function editsTheTransferFunction({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&quality=cells:20000`, {
    ...kDesktop,
    colorScheme: 'dark',
  });
  await viewer.waitForState('held');
  await viewer.waitForPicture();
  const {page} = viewer;
  const surface = await viewer.screenshot('volume-off');
  await page.getByRole('switch', {name: 'Volume'}).check();
  await viewer.restVolume();
  for (const name of ['Cell edges', 'Surface']) {
    const control = page.getByRole('switch', {name, exact: true});
    assert.ok(await control.isDisabled(), `${name} does nothing but is enabled`);
    assert.match(await control.getAttribute('title'), /^The volume takes the place/);
  }
  assert.ok(await page.getByRole('slider', {name: 'Opacity', exact: true}).isDisabled());
  const first = await viewer.screenshot('volume');
  assert.ok(
    differingShare(surface, first) > 0.02 && coloredShare(first) > 0.015,
    'the volume is not to be seen',
  );
  // The dark, faint end shows, too: the whole fin is there, on a ground that is the same
  // everywhere.
  const ground = first.at(100, 650);
  for (const [x, y] of [
    [450, 240],
    [650, 500],
    [700, 560],
    [800, 350],
  ]) {
    const steps = first.at(x, y).reduce((sum, value, c) => sum + Math.abs(value - ground[c]), 0);
    assert.ok(steps >= 5, `at ${x}, ${y} the volume is ${steps} steps off its ground`);
  }
  assert.deepEqual(first.at(860, 650), ground);
  await page.getByRole('button', {name: 'Denser'}).click();
  const opacities = async () =>
    (await page.evaluate(() => window.qtetViewer.getAttribute('volume'))).split(',').map(Number);
  const denser = await opacities();
  await page.getByRole('slider', {name: 'Opacity at 13 % of the range'}).focus();
  for (let i = 0; i < 20; ++i) await page.keyboard.press('ArrowDown');
  await viewer.restVolume();
  assert.ok(
    differingShare(first, await viewer.screenshot('volume-denser')) > 0.02,
    'the sliders change nothing',
  );
  const edited = await opacities();
  assert.ok(Math.abs(edited[1] - (denser[1] - 0.2)) < 0.006, `${denser} became ${edited}`);
  assert.equal(edited[0], denser[0]);
  await page.locator('qtet-viewer .scene').focus();
  for (let i = 0; i < 10; ++i) await page.keyboard.press('ArrowLeft');
  await viewer.restVolume();
  await viewer.screenshot('volume-turned');
  await page.getByRole('switch', {name: 'Volume'}).uncheck();
  assert.ok(await page.getByRole('switch', {name: 'Surface', exact: true}).isEnabled());
  await viewer.settle();
  const phone = await browser.open(
    `${server.url}?mesh=fin&quality=cells:20000&volume=0,0.2,0.6`,
    kPhone,
  );
  await phone.waitForState('held');
  await phone.waitForPicture();
  await phone.restVolume();
  await phone.page.getByRole('button', {name: 'Controls'}).tap();
  await phone.page.locator('qtet-viewer .volume').scrollIntoViewIfNeeded();
  await phone.settle();
  await phone.screenshot('volume-phone');
  assert.deepEqual([...viewer.problems, ...phone.problems], []);
}

/** The luminance of sRGB, of 255. */
const luminance = ([red, green, blue]) => 0.2126 * red + 0.7152 * green + 0.0722 * blue;
/** A volume's mean luminance differs at least so much from its ground's, of 255. */
const kMinContrast = 30;

/**
 * Most of this box has low values, whose colours are dark. Its volume shows on both grounds, and
 * stays so when the scheme changes.
 */
async function standsOffFromBothGrounds(context) {
  const {server, browser} = context;
  await serveMesh(context, 'skew', linearBox(4, {skew: (x, y, z) => (z / 3) ** 6}));
  const viewer = await browser.open(
    `${server.url}?mesh=skew&field=skew&volume=auto`,
    {...kScene, colorScheme: 'light'},
    hides('panel', 'legend'),
  );
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const inside = [0.3, 0.5, 0.7].flatMap((y) => [0.2, 0.35, 0.5].map((z) => [0.5, y, z]));
  const notes = [];
  for (const [colorScheme, ground] of [
    ['light', 255],
    ['dark', 20],
  ]) {
    await viewer.page.emulateMedia({colorScheme});
    await viewer.restVolume();
    await viewer.settle();
    await viewer.restVolume();
    await viewer.screenshot(`volume-skew-${colorScheme}`);
    const pixels = await pixelsAt(viewer, inside);
    const seen = pixels.map(([r, g, b, a]) => {
      const rest = ground * (1 - a / 255);
      return (luminance([r, g, b]) * a) / 255 + rest;
    });
    const contrast = Math.abs(seen.reduce((sum, its) => sum + its, 0) / seen.length - ground);
    notes.push(`${colorScheme} ${contrast.toFixed(0)}`);
    assert.ok(contrast >= kMinContrast, `${notes.join(', ')} of 255 off the ground`);
  }
  assert.deepEqual(viewer.problems, []);
  return `${notes.join(', ')} of 255 off the ground`;
}

/**
 * Slow graphics draw few cells and pixels while the camera is dragged, then all of both, in strips.
 */
async function drawsFewCellsWhileSomethingMoves({server, browser}) {
  const viewer = await browser.open(
    `${server.url}?mesh=fin&volume=0,0.1,0.3,0.6`,
    kScene,
    hides('panel', 'legend'),
  );
  const {page} = viewer;
  await page.addStyleTag({content: 'qtet-viewer { background: #fff }'});
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  await viewer.restVolume();
  const before = await viewer.screenshot('volume-rest');
  await viewer.inView(({scene: {volume}}) => {
    const seen = (globalThis.qtetSeen = {coarse: 0, cells: 0, strips: 0});
    const {drawer} = volume;
    const {caster, drawAtOnce} = drawer;
    const {cast} = caster;
    volume.wholeMs = Infinity; // a machine may be faster than that on such a small canvas
    drawer.drawAtOnce = (picture, its, share) => {
      if (its === volume.coarse) ++seen.coarse;
      seen.cells = its.shown.count;
      return drawAtOnce.call(drawer, picture, its, share);
    };
    caster.cast = (...words) => {
      if (volume.fine.shown.links === caster.ray.links) ++seen.strips;
      cast.apply(caster, words);
    };
  });
  await page.mouse.move(200, 150);
  await page.mouse.down();
  await page.mouse.move(260, 170, {steps: 4});
  await viewer.waitInView(() => globalThis.qtetSeen.coarse > 0);
  await page.mouse.move(300, 180, {steps: 4});
  await page.mouse.up();
  await viewer.restVolume();
  const seen = await viewer.inView(() => globalThis.qtetSeen);
  assert.ok(seen.cells > 1000 && seen.cells <= 8000 && seen.strips > 2, JSON.stringify(seen));
  const atRest = await viewer.screenshot('volume-rest-turned');
  assert.ok(largestDifference(before, atRest) > 30, 'dragging turns nothing');
  const whole = readPng(
    Buffer.from(
      await page.evaluate(async () => [
        ...new Uint8Array(
          await (await window.qtetViewer.meshView.picture('#ffffff')).arrayBuffer(),
        ),
      ]),
    ),
  );
  const off = largestDifference(atRest, whole);
  assert.ok(off <= 2, `the picture at rest is ${off} of 255 off the one that is asked for`);
  assert.deepEqual(viewer.problems, []);
  return `${seen.coarse} pictures of ${seen.cells} cells, then ${seen.strips} strips`;
}

/** Whatever changes the volume, slow graphics show few cells of it before all of them. */
async function drawsFewCellsOfANewVolumeFirst({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&clip=none`, kSmallDesktop);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  await viewer.inView(({scene}) => {
    const {awaits} = scene;
    const watch = ({drawer}) => {
      for (const way of ['drawAtOnce', 'drawStrips']) {
        const draw = drawer[way];
        drawer[way] = async (picture, its, ...words) => {
          globalThis.qtetDrawn.push(its === scene.volume.coarse ? 'few' : 'all');
          const done = await draw.call(drawer, picture, its, ...words);
          if (way === 'drawStrips') setTimeout(() => (scene.volume.wholeMs = Infinity));
          return done;
        };
      }
    };
    scene.awaits = (snapshot) => {
      const isNew = !scene.volume;
      const coming = awaits.call(scene, snapshot);
      return coming?.then((its) => {
        if (isNew && scene.volume) watch(scene.volume);
        return its;
      });
    };
  });
  const seen = [];
  for (const [name, value] of [
    ['volume', 'auto'],
    ['field', 'Pressure'],
    ['threshold', 'Density=1.5,4'],
    ['clip', 'y:0.5'],
  ]) {
    await viewer.inView(() => void (globalThis.qtetDrawn = []));
    await viewer.page.evaluate(
      ([its, text]) => window.qtetViewer.setAttribute(its, text),
      [name, value],
    );
    await viewer.waitInView(() => globalThis.qtetDrawn.length > 0);
    await viewer.screenshot(`volume-first-${name}`);
    await viewer.restVolume();
    const drawn = await viewer.inView(() => globalThis.qtetDrawn);
    assert.equal(drawn[0], 'few', `${name}: ${drawn}`);
    assert.equal(drawn.at(-1), 'all', `${name}: ${drawn}`);
    seen.push(`${name}: ${drawn}`);
  }
  assert.deepEqual(viewer.problems, []);
  return seen.join('; ');
}

/**
 * Runs in the worker that draws. Returns the RGBA of the volume alone in some pixels: once as
 * drawn, and once as a sum. The sum is that of all cells on the line of sight, searched one by one.
 */
function compareWithEveryCell(view, level) {
  const {volume, graphics} = view.scene;
  const {gl} = graphics;
  const {fromCanvas: m} = view.pose;
  const {
    drawer: {
      deep,
      caster: {look, ray},
    },
    fine: {
      of: {vertices, cells, tags, cellValues},
    },
  } = volume;
  const {width, height} = deep.volume;
  deep.volume.begin();
  const drawn = new Float32Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, drawn);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const cross = (a, b) => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
  ];
  const point = (x, y, z) =>
    [0, 1, 2].map(
      (i) =>
        (m[i] * x + m[i + 4] * y + m[i + 8] * z + m[i + 12]) /
        (m[3] * x + m[7] * y + m[11] * z + m[15]),
    );
  const at = (v) => [...vertices.subarray(4 * v, 4 * v + 4)];
  const [density, range, scale] = [look.density.values, look.range, look.scaleRange];
  const shareOf = (v) =>
    look.logarithmic
      ? Math.log((scale[0] + v * (scale[1] - scale[0])) / range[0]) / Math.log(range[1] / range[0])
      : (v - range[0]) / (range[1] - range[0]);
  const looks = (v) =>
    density
      .subarray(4 * Math.round(Math.min(1, Math.max(0, shareOf(v))) * (density.length / 4 - 1)))
      .subarray(0, 4);
  /** A gradient across the line of sight takes up to 45 % of the light, if it is steep. */
  const lightOf = (gradient, along, mean) => {
    const most = Math.hypot(...gradient);
    if (cellValues || most === 0) return 1;
    const shift = 1e-4;
    const steep =
      (most * (shareOf(mean + shift) - shareOf(mean - shift))) / (2 * shift * ray.perDiagonal);
    const facing = Math.abs(dot(gradient, along)) / most / Math.hypot(...along);
    return 1 - 0.45 * (steep ** 2 / (1 + steep ** 2)) * (1 - facing);
  };
  /** The part of a line within the cell, its values and light; null if there is none. */
  const stretch = (cell, from, along) => {
    const corners = [...cells.subarray(4 * cell, 4 * cell + 4)].map(at);
    let enter = -Infinity,
      leave = Infinity,
      value = 0,
      slope = 0,
      gradient = [0, 0, 0];
    for (let i = 0; i < 4; ++i) {
      const [a, b, c] = [1, 2, 3].map((k) => corners[(i + k) & 3]);
      const normal = cross(minus(b, a), minus(c, a)),
        whole = dot(normal, minus(corners[i], a));
      const share = dot(normal, minus(from, a)) / whole,
        change = dot(normal, along) / whole;
      value += share * (cellValues ? cellValues[cell] : corners[i][3]);
      slope += change * (cellValues ? cellValues[cell] : corners[i][3]);
      const share4 = cellValues ? 0 : corners[i][3] / whole;
      gradient = gradient.map((sum, axis) => sum + share4 * normal[axis]);
      if (change > 0) enter = Math.max(enter, -share / change);
      else if (change < 0) leave = Math.min(leave, -share / change);
      else if (share < 0) return null;
    }
    const mean = corners.reduce((sum, corner) => sum + corner[3] / 4, 0);
    return enter < leave
      ? {enter, leave, value, slope, light: lightOf(gradient, along, mean)}
      : null;
  };
  const pairs = [];
  for (let k = 0; k < 300; ++k) {
    const x = Math.floor(width * ((k * 0.6180339) % 1)),
      y = Math.floor((height * (k + 0.5)) / 300);
    const [from, to] = [-1, 1].map((z) =>
      point((2 * x + 1) / width - 1, (2 * y + 1) / height - 1, z),
    );
    const along = minus(to, from),
      reach = Math.hypot(...along);
    let first = 0,
      last = Infinity;
    for (let plane = 0; plane < look.clipPlanes.length; plane += 4) {
      const normal = look.clipPlanes.slice(plane, plane + 3);
      const room = look.clipPlanes[plane + 3] - dot(normal, from),
        change = -dot(normal, along);
      if (change > 0) first = Math.max(first, -room / change);
      else if (change < 0) last = Math.min(last, -room / change);
    }
    const color = [0, 0, 0, 0];
    let end = false,
      before = null;
    const found = Array.from(tags, (tag, cell) => (tag >>> 31 ? null : stretch(cell, from, along)))
      .filter((its) => its)
      .sort((a, b) => a.enter - b.enter);
    for (const {enter, leave, value, slope, light} of found) {
      const kParts = 64;
      for (let i = 0; i < kParts && !end; ++i) {
        const t = enter + ((i + 0.5) / kParts) * (leave - enter);
        if (t < first || t > last) continue;
        const now = value + t * slope;
        // a surface stands there
        if (level !== null && before !== null && (before - level) * (now - level) < 0) end = true;
        before = now;
        const its = looks(now),
          opacity = end
            ? 0
            : 1 - Math.exp((-its[3] * reach * (leave - enter) * ray.perDiagonal) / kParts);
        const rest = 1 - color[3];
        if (its[3] === 0) continue;
        for (let c = 0; c < 4; ++c)
          color[c] += ((c < 3 ? light : 1) * rest * opacity * its[c]) / its[3];
      }
    }
    pairs.push([[...drawn.subarray(4 * (y * width + x), 4 * (y * width + x) + 4)], color]);
  }
  return pairs;
}

/** Two pieces. One of them has a hole, a pit and a slit. */
const isThere = (x, y, z) =>
  y !== 5 &&
  !(x === 1 && y === 2 && z > 2 && z < 6) &&
  !(y < 4 && y !== 1 && z > 5) &&
  !(y === 3 && z === 1);
/**
 * Pages with several views each: their attributes, and the value of Density where an isosurface
 * ends the line of sight.
 */
const kCasts = {
  'mesh=holes&volume=0.05,0.2': {
    holes: [{field: 'x', camera: '1.6,2.2,0.7,0,0,0'}],
    parallel: [{projection: 'parallel'}],
    clipped: [{field: 'which', projection: 'perspective', clip: 'x:0.7,y:0.8,-z:0.1'}],
  },
  'mesh=fin&quality=cells:3000&field=Density&volume=0.1,0.2,0.3,0.6': {
    logarithmic: [{scale: 'log', range: '0.9..2'}],
    stopped: [{scale: 'linear', iso: 'Density=1.5'}, 1.5],
    hiddenInside: [{iso: 'off', threshold: 'Density=1.1..1.6', camera: '0.1,-0.35,0.1,0,0.3,0'}],
  },
};

async function castsRaysAsEveryCellSays(context) {
  const {server, browser} = context;
  await serveMesh(context, 'holes', linearBox(3, {}, isThere));
  const notes = [];
  for (const [query, views] of Object.entries(kCasts)) {
    const viewer = await browser.open(
      `${server.url}?${query}`,
      {...kScene, deviceScaleFactor: 1.5},
      hides('panel', 'legend'),
    );
    await viewer.waitForState(query.includes('quality') ? 'held' : 'complete');
    await viewer.waitForPicture();
    for (const [name, [attributes, level = null]] of Object.entries(views)) {
      await viewer.page.evaluate(
        (all) => Object.entries(all).forEach((its) => window.qtetViewer.setAttribute(...its)),
        attributes,
      );
      await viewer.restVolume();
      await viewer.screenshot(`volume-cast-${name}`);
      const [low, high] = await viewer.page.evaluate(
        () => window.qtetViewer.viewing.mesh.snapshot.scaleRange,
      );
      const pairs = await viewer.inView(
        compareWithEveryCell,
        level && (level - low) / (high - low),
      );
      const off = pairs.map(
        ([drawn, wanted]) =>
          255 * Math.max(...drawn.map((value, c) => Math.abs(value - wanted[c]))),
      );
      const shown = pairs.filter(([drawn, wanted]) => Math.max(drawn[3], wanted[3]) > 0.02).length;
      const others = off.filter((steps) => steps > 3).length;
      notes.push(`${name} ${others} of ${shown}, at most ${Math.max(...off).toFixed(1)}`);
      assert.ok(shown > 30, `${name}: ${shown} pixels show anything`);
      // If a surface ends the line of sight, a pixel may lie beside its edge.
      assert.ok(others <= (level === null ? 0.02 : 0.05) * shown, notes.at(-1));
    }
    assert.deepEqual(viewer.problems, []);
    await browser.closePages();
  }
  return notes.join('; ');
}

export const volumeChecks = {
  castsRaysAsEveryCellSays,
  drawsAVolumeAsTheFormulaSays,
  editsTheTransferFunction,
  standsOffFromBothGrounds,
  drawsFewCellsWhileSomethingMoves,
  drawsFewCellsOfANewVolumeFirst,
};
