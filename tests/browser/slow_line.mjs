// A slow line between the browser and a server, for measurements: all connections share its rate.

import {createServer, connect} from 'node:net';

const kTickMs = 5;
/** An idle line saves up no more than it brings in this time. */
const kMaxMs = 100;

export class SlowLine {
  #relay;
  #connections = new Set();
  #room = 0;
  #timer;
  /** Towards the browser, of all connections so far. */
  bytes = 0;

  /**
   * `bytesPerSecond` towards the browser in all. A byte takes half of `roundTripMs` each way, and a
   * connection takes one round trip to open.
   */
  static async open(targetPort, {bytesPerSecond, roundTripMs}) {
    const line = new SlowLine();
    const oneWayMs = roundTripMs / 2;
    line.#relay = createServer((browser) => {
      const server = connect(targetPort, '127.0.0.1');
      const connection = {browser, server, queue: [], ended: false};
      line.#connections.add(connection);
      const end = () => {
        browser.destroy();
        server.destroy();
        line.#connections.delete(connection);
      };
      for (const socket of [browser, server]) socket.on('error', end).setNoDelay(true);
      browser.on('close', end);
      let ready = Date.now() + roundTripMs;
      browser.on('data', (bytes) => {
        ready = Math.max(ready, Date.now());
        setTimeout(() => server.writable && server.write(bytes), ready - Date.now() + oneWayMs);
      });
      server.on('data', (bytes) => {
        connection.queue.push(bytes);
        server.pause(); // the server feels the line
      });
      server.on('close', () => {
        connection.ended = true;
        if (connection.queue.length === 0) setTimeout(end, oneWayMs);
      });
    });
    let before = performance.now();
    line.#timer = setInterval(() => {
      // a busy machine calls late
      const now = performance.now();
      const most = (bytesPerSecond * kMaxMs) / 1000;
      line.#room = Math.min(line.#room + (bytesPerSecond * (now - before)) / 1000, most);
      before = now;
      line.#share(oneWayMs);
    }, kTickMs);
    await new Promise((resolve) => void line.#relay.listen(0, '127.0.0.1', resolve));
    return line;
  }

  /** Each connection that has something gets as much as the others, a packet at a time. */
  #share(oneWayMs) {
    const kPacket = 1400;
    for (let waiting = true; waiting && this.#room > 0;) {
      waiting = false;
      for (const connection of [...this.#connections]) {
        const {browser, server, queue, ended} = connection;
        const [first] = queue;
        if (!first || this.#room <= 0) continue;
        waiting = true;
        this.#connections.delete(connection); // behind the others, also in the next tick
        this.#connections.add(connection);
        const part = first.subarray(0, kPacket);
        if (part.length < first.length) queue[0] = first.subarray(kPacket);
        else queue.shift();
        if (queue.length === 0) server.resume();
        if (queue.length === 0 && ended) setTimeout(() => browser.end(), oneWayMs + kMaxMs);
        this.#room -= part.length;
        this.bytes += part.length;
        setTimeout(() => browser.writable && browser.write(part), oneWayMs);
      }
    }
  }

  get url() {
    return `http://127.0.0.1:${this.#relay.address().port}/`;
  }

  close() {
    clearInterval(this.#timer);
    for (const {browser, server} of this.#connections) {
      browser.destroy();
      server.destroy();
    }
    this.#relay.close();
  }
}
