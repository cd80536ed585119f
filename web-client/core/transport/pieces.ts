// Joins the pieces of a block (proto/STREAM.md, "Binary frame"). Slow lines get large blocks so.

import type {Frame} from '../protocol/messages';
import {kHeadPart} from '../protocol/parts';

/** The pieces of one stream, of several blocks at a time. */
export class Pieces {
  private readonly begun = new Map<string, Uint8Array[]>();

  /**
   * The frame with all bytes of its first block, or null while bytes of that block are to come.
   */
  join(frame: Frame): Frame | null {
    if (frame.firstPart === kHeadPart) return frame;
    const key = `${frame.chunk} ${frame.firstPart}`;
    const begun = this.begun.get(key);
    if (frame.parts === 0) {
      if (begun) begun.push(frame.payload);
      else this.begun.set(key, [frame.payload]);
      return null;
    }
    if (!begun) return frame;
    this.begun.delete(key);
    return {...frame, payload: joined([...begun, frame.payload])};
  }
}

function joined(pieces: readonly Uint8Array[]): Uint8Array {
  const out = new Uint8Array(pieces.reduce((sum, piece) => sum + piece.length, 0));
  let at = 0;
  for (const piece of pieces) {
    out.set(piece, at);
    at += piece.length;
  }
  return out;
}
