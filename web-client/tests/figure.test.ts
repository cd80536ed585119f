import {describe, expect, test} from 'vitest';
import {colorGradient, labelGradient} from '../core/picture/color_maps';
import {
  frameOf,
  refusalOf,
  stopsOf,
  unitOf,
  type Figure,
  type LegendTexts,
} from '../viewer/picture/figure';

const kFigure: Figure = {
  width: 3000,
  height: 2000,
  ground: 'white',
  hasLegend: true,
  hasAxes: true,
  title: 'fin',
  unit: 'Pa',
};
const kLegend: LegendTexts = {
  name: 'Pressure',
  factor: '',
  gradient: '',
  ticks: [],
  endColors: ['', ''],
  marks: [],
  labels: [],
  notes: [],
  missing: '',
};
const kCanvas = {clientWidth: 1280, clientHeight: 800};

describe('stops of a gradient', () => {
  test('areSpacedEvenlyIfItDoesNotSayWhere', () => {
    expect(stopsOf('linear-gradient(90deg, rgb(68, 1, 84), rgb(1, 2, 3), rgb(9 8 7))')).toEqual([
      [0, 'rgb(68, 1, 84)'],
      [0.5, 'rgb(1, 2, 3)'],
      [1, 'rgb(9 8 7)'],
    ]);
    expect(stopsOf(colorGradient('viridis', false, 33))).toHaveLength(33);
  });
  test('standWhereItSays', () => {
    const stops = stopsOf(labelGradient(3));
    expect(stops.map(([at]) => at.toFixed(2))).toEqual([
      '0.00',
      '0.33',
      '0.33',
      '0.67',
      '0.67',
      '1.00',
    ]);
    expect(stops[0]![1]).toBe(stops[1]![1]);
    expect(stopsOf('radial-gradient(120% 90% at 42% 38%, #ffffff 0%, rgb(1, 2, 3) 55%)')).toEqual([
      [0, '#ffffff'],
      [0.55, 'rgb(1, 2, 3)'],
    ]);
  });
  test('areNoneOfNoGradient', () => expect(stopsOf('none')).toEqual([]));
});

describe('the frame of a figure', () => {
  test('leavesRoomForWhatStandsRoundTheMesh', () => {
    const none = {...kFigure, title: '', hasLegend: false};
    const below = (legend: LegendTexts): number => frameOf(kFigure, legend, kCanvas).insets.bottom;
    expect(frameOf(none, kLegend, kCanvas).insets).toEqual({left: 0, right: 0, top: 0, bottom: 0});
    const unnamed = frameOf({...none, hasLegend: true}, null, kCanvas);
    expect(unnamed.insets.bottom).toBe(0);
    const titled = frameOf({...none, title: 'fin'}, kLegend, kCanvas).insets;
    expect(titled.top).toBeGreaterThan(0.05);
    expect(titled.bottom).toBe(0);
    const whole = below(kLegend);
    expect(whole).toBeGreaterThan(titled.top);
    const noted = below({...kLegend, notes: ['No value']});
    expect(noted).toBeGreaterThan(whole);
    expect(noted).toBeLessThan(0.2);
    const labels = Array.from({length: 12}, (_, i) => ({
      text: `a winding made of copper ${i}`,
      color: 'red',
    }));
    const listed = below({...kLegend, labels});
    expect(listed).toBeGreaterThan(noted);
    expect(below({...kLegend, labels: labels.map((its) => ({...its, text: '1'}))})).toBeLessThan(
      listed,
    );
  });
  test('growsWithThePictureSoThatItLooksTheSame', () => {
    const twice = {...kFigure, width: 6000, height: 4000};
    expect(unitOf(twice)).toBeCloseTo(2 * unitOf(kFigure));
    expect(frameOf(twice, kLegend, kCanvas).insets.bottom).toBeCloseTo(
      frameOf(kFigure, kLegend, kCanvas).insets.bottom,
    );
    expect(frameOf(twice, kLegend, kCanvas).pixelRatio).toBeCloseTo(
      2 * frameOf(kFigure, kLegend, kCanvas).pixelRatio,
    );
  });
  test('leavesMostOfALowPictureToTheMesh', () => {
    const low = {...kFigure, width: 6000, height: 300};
    const {top, bottom} = frameOf(low, kLegend, kCanvas).insets;
    expect(top + bottom).toBeCloseTo(0.6);
  });
});

test.each([
  [7680, 4320, /^$/],
  [4320, 7680, /^$/],
  [100, 100, /^$/],
  [7681, 100, /from 100 to 7680/],
  [99, 100, /from 100 to 7680/],
  [7680, 4321, /7680 × 4320 pixels/],
  [1000.5, 1000, /whole numbers/],
  [NaN, 1000, /whole numbers/],
])('aPictureOf%dx%dIsMadeOrRefusedByASentence', (width, height, said) => {
  expect(refusalOf({width, height})).toMatch(said);
});
