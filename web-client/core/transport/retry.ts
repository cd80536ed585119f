// Retries what the network made fail: the viewer's own parts come over the same line as the mesh.

import {reconnectDelayMs} from './backoff';

export const kMaxAttempts = 8;

/**
 * Calls `action` until it succeeds, with growing pauses between failures. Throws the last failure,
 * or the first one that `mayPass` says will stay.
 */
export async function retry<T>(
  action: () => Promise<T>,
  random: () => number = Math.random,
  mayPass: (thrown: unknown) => boolean = () => true,
): Promise<T> {
  for (let attempt = 0; ; ++attempt) {
    try {
      return await action();
    } catch (thrown) {
      if (attempt + 1 >= kMaxAttempts || !mayPass(thrown)) throw thrown;
      await new Promise((resolve) => setTimeout(resolve, reconnectDelayMs(attempt, random())));
    }
  }
}
