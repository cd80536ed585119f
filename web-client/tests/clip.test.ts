import {describe, expect, it} from 'vitest';
import {parseClip} from '../viewer/clip_panel';

describe('parseClip', () => {
  it('reads an axis, a share and a side', () => {
    expect(parseClip('y')).toEqual({axis: 1, share: 0.5, flipped: false});
    expect(parseClip('x:0.25')).toEqual({axis: 0, share: 0.25, flipped: false});
    expect(parseClip('-z:1')).toEqual({axis: 2, share: 1, flipped: true});
  });

  it('takes anything else for no clip', () => {
    for (const text of [null, '', 'w', 'y:', 'y:2', 'y:-1', 'y:0.5x', 'yy', '--y']) expect(parseClip(text)).toBeNull();
  });
});
