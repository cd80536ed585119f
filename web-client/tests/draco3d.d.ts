// draco3d, Draco's own coder, has no types. These cover what the tests use.
declare module 'draco3d' {
  export interface Draco {
    Decoder: new () => {
      DecodeBufferToPointCloud(buffer: unknown, cloud: unknown): {ok(): boolean};
      GetAttribute(cloud: unknown, id: number): unknown;
      GetAttributeDataArrayForAllPoints(
        cloud: unknown,
        attribute: unknown,
        type: number,
        bytes: number,
        address: number,
      ): boolean;
    };
    PointCloud: new () => object;
    DecoderBuffer: new () => {Init(bytes: Int8Array, size: number): void};
    DT_INT32: number;
    HEAP32: Int32Array;
    _malloc(bytes: number): number;
    _free(address: number): void;
    destroy(object: object): void;
  }
  const draco3d: {createDecoderModule(options: object): Promise<Draco>};
  export default draco3d;
}
