// The state of a session. It is always exactly one of these, and the page receives every change.

import type {FromWorker, StreamState} from './worker_messages';

export type SessionState =
  | {name: Exclude<StreamState, 'reconnecting'>}
  | {name: 'reconnecting'; attempt: number; delayMs: number};

/** The network is idle: the user has paused it, or nothing is missing. */
export function isAtRest({name}: SessionState): boolean {
  return name === 'paused' || name === 'held' || name === 'complete';
}

export function canPause({name}: SessionState): boolean {
  return name !== 'paused' && name !== 'complete' && name !== 'failed';
}

export function stateMessage(state: SessionState): FromWorker {
  const {attempt, delayMs} = state.name === 'reconnecting' ? state : {attempt: 0, delayMs: 0};
  return {type: 'state', state: state.name, attempt, delayMs};
}
