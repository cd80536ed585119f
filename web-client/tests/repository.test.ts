import {tmpdir} from 'node:os';
import {describe, expect, it} from 'vitest';
import {originOf, repositoryOf} from '../repository.mjs';

describe('the repository that the npm package names', () => {
  it('is the remote of the checkout, whatever way it was cloned', () => {
    const wanted = {
      type: 'git',
      url: 'git+https://forge.example/team/qtet.git',
      directory: 'web-client',
    };
    for (const url of [
      'https://forge.example/team/qtet.git',
      'https://user@forge.example/team/qtet/',
      'ssh://git@forge.example/team/qtet.git',
      'git@forge.example:team/qtet.git',
      'git@forge.example:team/qtet',
    ])
      expect(repositoryOf(url), url).toEqual(wanted);
  });

  it('is left out where the remote is a folder, or there is none', () => {
    for (const url of ['', '/srv/git/qtet', '../qtet', 'file:///srv/git/qtet', 'C:\\qtet'])
      expect(repositoryOf(url), url).toBeUndefined();
    expect(originOf(tmpdir())).toBe('');
  });
});
