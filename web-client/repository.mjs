import {execFileSync} from 'node:child_process';

/**
 * Where the sources are, as npm's `repository` wants it, of the remote `url` of a checkout.
 * Nothing where `url` says nothing to others: a folder of this machine, or none at all.
 */
export function repositoryOf(url) {
  const scp = /^(?:[^@/]+@)?([^/:]+\.[^/:]+):(?!\/\/)(.+)$/.exec(url);
  const parts = scp ?? /^(?:https|ssh|git):\/\/(?:[^@/]*@)?([^/]+)\/(.+)$/.exec(url);
  if (!parts) return undefined;
  const [, host, path] = parts;
  return {
    type: 'git',
    url: `git+https://${host}/${path.replace(/(?:\.git)?\/*$/, '')}.git`,
    directory: 'web-client',
  };
}

/** The address that the checkout at `folder` came from; '' without one. */
export function originOf(folder) {
  try {
    return execFileSync('git', ['-C', folder, 'remote', 'get-url', 'origin'], {
      encoding: 'utf8',
      stdio: ['ignore', 'pipe', 'ignore'],
    }).trim();
  } catch {
    return '';
  }
}
