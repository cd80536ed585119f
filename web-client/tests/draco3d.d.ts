// draco3d, Draco's own coder, has no types; only tests use it.
declare module 'draco3d';
