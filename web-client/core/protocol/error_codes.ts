/** Names by ErrorCode of proto/error.h. */
export const kErrorCodes = [
  'truncated',
  'bad-magic',
  'bad-version',
  'bad-checksum',
  'bad-value',
  'limit-exceeded',
  'bad-codec',
  'bad-order',
  'not-found',
  'bad-input',
  'io',
  'cancelled',
];
