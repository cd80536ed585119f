// A .zip file whose files are stored, not compressed (PKWARE's APPNOTE, 4.3.7, 4.3.12 and 4.3.16).

import {crc32} from './crc32';

const kVersion = 20;
/** Names are UTF-8 (4.4.4, bit 11). */
const kFlags = 1 << 11;
const kMaxFiles = 0xffff;
/** A larger file needs the fields of Zip64, which are not written. */
const kMaxBytes = 0xffffffff;

interface Entry {
  name: Uint8Array<ArrayBuffer>;
  /** All of its header that both places share. */
  common: Uint8Array<ArrayBuffer>;
  at: number;
}

export class Zip {
  private readonly parts: BlobPart[] = [];
  private readonly entries: Entry[] = [];
  private bytes = 0;

  constructor(private readonly now = new Date()) {}

  async add(name: string, file: Blob): Promise<void> {
    const data = new Uint8Array(await file.arrayBuffer());
    const entry = {
      name: new TextEncoder().encode(name),
      common: this.commonOf(data),
      at: this.bytes,
    };
    const {length} = entry.name;
    entry.common.set([length & 0xff, length >> 8], 22);
    this.append(uint32(0x04034b50), entry.common, entry.name, file);
    this.entries.push(entry);
    const isTooLarge = this.bytes > kMaxBytes || this.entries.length > kMaxFiles;
    if (isTooLarge) throw new Error('A .zip file holds at most 4 GB and 65535 pictures.');
  }

  /** REQUIRES: it is called once. */
  end(): Blob {
    const start = this.bytes;
    const {length} = this.entries;
    for (const {name, common, at} of this.entries) {
      const rest = new Uint8Array(14); // no comment, disk 0, no attributes
      rest.set(uint32(at), 10);
      this.append(uint32(0x02014b50), uint16(kVersion), common, rest, name);
    }
    const size = this.bytes - start;
    const counts = [uint16(length), uint16(length), uint32(size), uint32(start)];
    this.append(uint32(0x06054b50), uint32(0), ...counts, uint16(0));
    return new Blob(this.parts, {type: 'application/zip'});
  }

  private append(...parts: (Uint8Array<ArrayBuffer> | Blob)[]): void {
    for (const part of parts) this.bytes += part instanceof Blob ? part.size : part.length;
    this.parts.push(...parts);
  }

  /** From the version on to the lengths of the name and of the extra field. */
  private commonOf(data: Uint8Array): Uint8Array<ArrayBuffer> {
    const {now} = this;
    const header = new DataView(new ArrayBuffer(26));
    const time = (now.getHours() << 11) | (now.getMinutes() << 5) | (now.getSeconds() >> 1);
    const day = ((now.getFullYear() - 1980) << 9) | ((now.getMonth() + 1) << 5) | now.getDate();
    header.setUint16(0, kVersion, true);
    header.setUint16(2, kFlags, true);
    header.setUint16(6, time, true); // behind method 0: stored
    header.setUint16(8, day, true);
    header.setUint32(10, crc32(data), true);
    header.setUint32(14, data.length, true);
    header.setUint32(18, data.length, true);
    return new Uint8Array(header.buffer);
  }
}

const uint16 = (value: number): Uint8Array<ArrayBuffer> =>
  new Uint8Array([value & 0xff, value >> 8]);
const uint32 = (value: number): Uint8Array<ArrayBuffer> =>
  new Uint8Array([value, value >> 8, value >> 16, value >>> 24]);
