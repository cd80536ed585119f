// The peer of stream_bench.py: the same chunks by npm's ws, as one would write it. Prints its port.
//
//   node server_peer.mjs FOLDER_WITH_node_modules FILE CHUNK_BYTES
import {createRequire} from 'node:module';
import {readFileSync} from 'node:fs';

const [folder, file, chunkBytes] = process.argv.slice(2);
const {WebSocketServer} = createRequire(folder + '/')('ws');
const bytes = readFileSync(file);
const step = Number(chunkBytes);
const server = new WebSocketServer({port: 0, host: '127.0.0.1', perMessageDeflate: false});
server.on('connection', (socket) => {
  socket.on('error', () => {});
  socket.on('message', async () => {
    for (let at = 0; at < bytes.length; at += step) {
      const sent = new Promise((resolve) => socket.send(bytes.subarray(at, at + step), resolve));
      // A server must not let unread data pile up.
      if (socket.bufferedAmount > 1 << 18) await sent;
    }
    socket.send('{"stream":1,"type":"done"}');
  });
});
server.on('listening', () => console.log(server.address().port));
