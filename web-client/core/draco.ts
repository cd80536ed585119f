// Positions and field blocks: each is one Draco point cloud, sequential, with one generic attribute of 32-bit integers.

import makeDraco from 'draco3d/draco_decoder_nodejs.js';
import type {DracoAttribute, DracoDecoder, DracoModule, DracoPointCloud} from 'draco3d/draco_decoder_nodejs.js';
import {errorText, QtetError} from './errors';

export interface ValueDecoder {
  /** `count` tuples of `components` integers. Throws `bad-codec` when Draco refuses the bytes, `bad-value` when they hold anything else. */
  decode(bytes: Uint8Array, count: number, components: number): Int32Array;
}

export class DracoValueDecoder implements ValueDecoder {
  private constructor(private readonly draco: DracoModule) {}

  static async create(module: WebAssembly.Module): Promise<DracoValueDecoder> {
    const instantiateWasm = (imports: WebAssembly.Imports, done: (instance: WebAssembly.Instance) => void): object => {
      void WebAssembly.instantiate(module, imports).then(done);
      return {};
    };
    return new DracoValueDecoder(await makeDraco({instantiateWasm}));
  }

  decode(bytes: Uint8Array, count: number, components: number): Int32Array {
    if (!announces(bytes, count)) throw new QtetError('bad-value', 'A block of the mesh holds other values than its chunk table says.');
    const draco = this.draco;
    const buffer = new draco.DecoderBuffer();
    const decoder = new draco.Decoder();
    const cloud = new draco.PointCloud();
    try {
      buffer.Init(new Int8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength), bytes.byteLength);
      if (decoder.GetEncodedGeometryType(buffer) !== draco.POINT_CLOUD) throw refused('it is not a Draco point cloud');
      const status = decoder.DecodeBufferToPointCloud(buffer, cloud);
      if (!status.ok()) throw refused(`Draco says "${status.error_msg()}"`);
      const attribute = cloud.num_attributes() === 1 ? decoder.GetAttribute(cloud, 0) : null;
      if (attribute?.data_type() !== draco.DT_INT32 || attribute.num_components() !== components || cloud.num_points() !== count) {
        throw new QtetError('bad-value', 'A block of the mesh holds other values than its chunk table says.');
      }
      return this.values(decoder, cloud, attribute, count * components);
    } catch (thrown) {
      throw thrown instanceof QtetError ? thrown : refused(errorText(thrown));  // what Draco throws, it throws in its own ways
    } finally {
      draco.destroy(cloud);
      draco.destroy(decoder);
      draco.destroy(buffer);
    }
  }

  private values(decoder: DracoDecoder, cloud: DracoPointCloud, attribute: DracoAttribute, count: number): Int32Array {
    const draco = this.draco;
    const size = 4 * count;
    const address = draco._malloc(size);
    try {
      if (!decoder.GetAttributeDataArrayForAllPoints(cloud, attribute, draco.DT_INT32, size, address)) throw refused('its values are missing');
      return draco.HEAP32.slice(address >> 2, (address + size) >> 2);
    } finally {
      draco._free(address);
    }
  }
}

/** Whether a Draco stream says at its start that it is sequential and of `count` points: a constant costs no bits, so nothing else bounds what
 *  decoding allocates. Other bytes pass: Draco itself refuses them. */
function announces(bytes: Uint8Array, count: number): boolean {
  const kMethodAt = 8, kPointsAt = 11;
  if (bytes.length < kPointsAt + 4 || String.fromCharCode(...bytes.subarray(0, 5)) !== 'DRACO') return true;
  return bytes[kMethodAt] === 0 && new DataView(bytes.buffer, bytes.byteOffset).getUint32(kPointsAt, true) === count;
}

function refused(why: string): QtetError {
  return new QtetError('bad-codec', `A block of the mesh cannot be decoded: ${why}.`);
}
