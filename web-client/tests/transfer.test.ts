import {expect, test} from 'vitest';
import {colorTable} from '../core/picture/color_maps';
import {extinctionOf, kOpacityPath, kTransferSteps, transferTables} from '../core/picture/transfer';

test('theTablesHoldExtinctionAndItsIntegral', () => {
  const {density, integral} = transferTables([0, 0.5], 'grey', false);
  const last = extinctionOf(0.5);
  expect(1 - Math.exp(-last * kOpacityPath)).toBeCloseTo(0.5);
  expect(density[4 * kTransferSteps + 3]).toBeCloseTo(last, 4);
  expect(integral[4 * kTransferSteps + 3]).toBeCloseTo(last / 2, 4);
});

/** In degrees. */
function hueOf([red, green, blue]: number[]): number {
  return (Math.atan2(Math.sqrt(3) * (green! - blue!), 2 * red! - green! - blue!) * 180) / Math.PI;
}

test('coloursStandOffFromADarkGroundAndKeepTheirHue', () => {
  for (const map of ['viridis', 'turbo', 'cool-warm'] as const) {
    const {density} = transferTables([0.5, 0.5], map, false, true);
    const table = colorTable(map);
    for (const [step, entry] of [
      [0, 0],
      [kTransferSteps, 255],
    ] as const) {
      const seen = [0, 1, 2].map((c) => density[4 * step + c]! / density[4 * step + 3]!);
      const luminance = 0.2126 * seen[0]! + 0.7152 * seen[1]! + 0.0722 * seen[2]!;
      expect(luminance).toBeGreaterThan(0.25);
      const plain = [...table.subarray(4 * entry, 4 * entry + 3)];
      expect(Math.abs(hueOf(seen) - hueOf(plain))).toBeLessThan(3);
    }
  }
});
