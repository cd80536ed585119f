// Browsers do not tell a page why it may not read another host's answer. A request without CORS
// tells it from a host that does not answer.

import {QtetError} from '../protocol/errors';

/**
 * An error that names CORS if the host of `url` answers but does not allow this page's origin; else
 * null. Must be called after a failed fetch.
 */
export async function refusedOrigin(url: string): Promise<QtetError | null> {
  const here = globalThis.location as Location | undefined;
  if (!here || new URL(url, here.href).origin === here.origin) return null;
  try {
    await fetch(url, {mode: 'no-cors', method: 'HEAD'});
  } catch {
    return null;
  }
  const {host} = new URL(url, here.href);
  return new QtetError(
    'cors',
    `${host} answers, but its CORS headers do not let a page of ${here.origin} read it. It has ` +
      `to send "Access-Control-Allow-Origin: ${here.origin}" (qtet-server: --allow-origins).`,
  );
}
