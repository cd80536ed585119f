import {expect, test} from 'vitest';
import {extinctionOf, kOpacityPath, kTransferSteps, transferTables} from '../core/picture/transfer';

test('theTablesHoldExtinctionAndItsIntegral', () => {
  const {density, integral} = transferTables([0, 0.5], 'grey', false);
  const last = extinctionOf(0.5);
  expect(1 - Math.exp(-last * kOpacityPath)).toBeCloseTo(0.5);
  expect(density[4 * kTransferSteps + 3]).toBeCloseTo(last, 4);
  expect(integral[4 * kTransferSteps + 3]).toBeCloseTo(last / 2, 4);
});
