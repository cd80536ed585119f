// A slow line between the browser and the server: a TCP relay with a rate and a delay. It passes on
// lost connections.

import {createServer, connect} from 'node:net';

const kTickMs = 20;

export class PoorLine {
  #relay;
  #connections = new Set();
  /** The rate towards the browser on each slow connection; it may change. */
  bytesPerSecond;
  /** If true, no WebSocket gets through, as behind some companies' proxies. */
  refuseStreams = false;

  /**
   * `bytesPerSecond` towards the browser on each connection, or on those of /v1/stream only;
   * `delayMs` is added each way. On the first connection of /v1/stream byte `damageAt` arrives
   * changed, or nothing at all behind the first `holdAt` bytes, however slow this machine is.
   */
  static async open(
    targetPort,
    {bytesPerSecond = Infinity, delayMs = 0, streamsOnly = false, damageAt = -1, holdAt = Infinity},
  ) {
    const line = new PoorLine();
    line.bytesPerSecond = bytesPerSecond;
    line.#relay = createServer((browser) => {
      const server = connect(targetPort, '127.0.0.1');
      const end = () => {
        browser.destroy();
        server.destroy();
        line.#connections.delete(end);
      };
      line.#connections.add(end);
      for (const socket of [browser, server])
        socket.on('error', end).on('close', end).setNoDelay(true);
      let slow = !streamsOnly;
      let damage = -1;
      let room = Infinity;
      browser.on('data', (bytes) => {
        const stream = bytes.includes('GET /v1/stream');
        if (stream && line.refuseStreams) return void end();
        slow ||= stream;
        if (stream) [damage, damageAt, room, holdAt] = [damageAt, -1, holdAt, Infinity];
        setTimeout(() => server.writable && server.write(bytes), delayMs);
      });
      relaySlowly(
        server,
        browser,
        () => Math.min(room, slow ? (line.bytesPerSecond * kTickMs) / 1000 : Infinity),
        delayMs,
        (bytes) => {
          room -= bytes.length;
          if (damage >= 0 && damage < bytes.length) bytes[damage] ^= 1;
          damage -= bytes.length;
        },
      );
    });
    await new Promise((resolve) => void line.#relay.listen(0, '127.0.0.1', resolve));
    return line;
  }

  get url() {
    return `http://127.0.0.1:${this.#relay.address().port}/`;
  }
  /**
   * Breaks every connection, including what is under way. The death of a server alone leaves its
   * last megabytes in the kernel.
   */
  cut() {
    for (const end of [...this.#connections]) end();
  }

  close() {
    this.#relay.close();
  }
}

/**
 * Passes on `portion()` bytes a tick. It reads no further ahead, so that the server feels the line.
 */
function relaySlowly(from, to, portion, delayMs, spoil) {
  const timer = setInterval(() => {
    const bytes = from.read(Math.min(portion(), from.readableLength));
    if (bytes) spoil(bytes);
    if (bytes) setTimeout(() => to.writable && to.write(bytes), delayMs);
  }, kTickMs);
  from.on('close', () => clearInterval(timer));
}
