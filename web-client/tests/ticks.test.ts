import {expect, test} from 'vitest';
import {niceTicks} from '../core/picture/ticks';

const labels = (low: number, high: number, max = 6): string[] =>
  niceTicks(low, high, max).ticks.map(({label}) => label);

test('stepsAreRound', () => {
  expect(labels(0, 1)).toEqual(['0.0', '0.2', '0.4', '0.6', '0.8', '1.0']);
  expect(labels(0, 58)).toEqual(['0', '10', '20', '30', '40', '50']);
  expect(labels(-1, 1, 5)).toEqual(['\u22121.0', '\u22120.5', '0.0', '0.5', '1.0']);
});

test('ticksStandWhereTheirNumbersAre', () => {
  for (const {at, label} of niceTicks(-3, 7, 6).ticks)
    expect(-3 + 10 * at).toBeCloseTo(Number(label.replace('\u2212', '-')), 9);
});

test('largeAndSmallNumbersShareOneFactor', () => {
  expect(niceTicks(98000, 218000, 6)).toMatchObject({factor: '× 10⁵'});
  expect(labels(98000, 218000)).toEqual(['1.0', '1.2', '1.4', '1.6', '1.8', '2.0']);
  expect(niceTicks(0, 2.5e-7, 6).factor).toBe('× 10⁻⁷');
  expect(niceTicks(0, 99999, 6).factor).toBe('');
});

test('aNarrowRangeRoundALargeValueKeepsItsDigits', () => {
  expect(niceTicks(101325, 101326, 6)).toMatchObject({
    factor: '+ 101325',
    ticks: [{at: 0, label: '0.0'}, {label: '0.2'}, {}, {}, {}, {at: 1, label: '1.0'}],
  });
  expect(niceTicks(101325, 101325.02, 6)).toMatchObject({
    factor: '+ 101325',
    ticks: [{label: '0.000'}, {label: '0.005'}, {}, {}, {label: '0.020'}],
  });
  expect(niceTicks(-293.1505, -293.15, 6)).toMatchObject({
    factor: '× 10⁻⁴ \u2212 293.1505',
    ticks: [{label: '0'}, {label: '1'}, {}, {}, {}, {label: '5'}],
  });
  expect(niceTicks(1.5e12, 1.5e12 + 2e6, 6)).toMatchObject({
    factor: '× 10⁶ + 1500000000000',
    ticks: [{label: '0.0'}, {label: '0.5'}, {}, {}, {}],
  });
});

test('aConstantFieldGetsOneTick', () => {
  expect(niceTicks(3.25, 3.25, 6).ticks).toEqual([{at: 0, label: '3.25'}]);
  expect(niceTicks(0, 0, 6).ticks).toEqual([{at: 0, label: '0'}]);
});

test('anyRangeGetsTwoToSixTicksInsideTheBar', () => {
  let seed = 1;
  const random = (): number => (seed = (seed * 48271) % 2147483647) / 2147483647;
  for (let i = 0; i < 2000; ++i) {
    const size = 10 ** (24 * random() - 12);
    const low = (random() - 0.5) * size;
    const {ticks} = niceTicks(low, low + size * (1e-3 + random()), 6);
    expect(ticks.length).toBeGreaterThanOrEqual(2);
    expect(ticks.length).toBeLessThanOrEqual(6);
    for (const {at} of ticks) expect(at >= 0 && at <= 1).toBe(true);
  }
});
