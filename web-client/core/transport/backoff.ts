// How long to wait before the n-th attempt to connect again.

export const kFirstDelayMs = 250;
export const kLongestDelayMs = 8000;

/**
 * Doubles from 250 ms to 8 s. The random half keeps many viewers from reconnecting at the same
 * moment. `random` is in [0, 1).
 */
export function reconnectDelayMs(attempt: number, random: number): number {
  const full = Math.min(kLongestDelayMs, kFirstDelayMs * 2 ** Math.min(attempt, 16));
  return Math.round(full * (0.5 + 0.5 * random));
}
