// Workers under a strict Content Security Policy.

interface TypePolicies {
  readonly defaultPolicy: unknown;
  createPolicy(name: string, rules: {createScriptURL(url: string): string}): void;
}

/**
 * For a page of our own under `require-trusted-types-for 'script'`: workers come from the page's
 * origin alone. It may be called again.
 */
export function trustOwnWorkers(): void {
  const policies = (globalThis as {trustedTypes?: TypePolicies}).trustedTypes;
  if (policies?.defaultPolicy) return;
  policies?.createPolicy('default', {
    createScriptURL: (url) => {
      if (new URL(url, location.href).origin === location.origin) return url;
      throw new TypeError(`${url} is not of this page's origin`);
    },
  });
}
